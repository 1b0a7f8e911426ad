"""Arms of any maker: read from URDF and tables, recognized, moved, written as URDF and MJCF."""
