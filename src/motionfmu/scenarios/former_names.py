"""Names that variables of FMUs had in earlier versions: who writes one is told the new one.

An old name is refused (docs/decisions/house/deprecations.md).
"""

# Version that renamed; by FMU the new name of each old one.
RENAMED: dict[str, dict[str, dict[str, str]]] = {
    "0.2": {
        "hydraulic_axis": {
            "position": "table_position",
            "velocity": "table_speed",
            "scale_phase": "table_phase",
            "home": "home_switch",
            "load_force": "force",
        },
        "mcc_groups": {
            "card1_dac_track_limit": "card1_dac_track_error_limit",
            "card2_dac_track_limit": "card2_dac_track_error_limit",
        },
        "robot_arm": {"start_angle": "start_joint"},
        "servo_drives": {"enc_lines": "encoder_lines", "enc_counts": "encoder_counts"},
        "stepper_axes": {
            "coulomb": "motor_coulomb",
            "viscous": "motor_viscous",
            "rest_speed": "motor_rest_speed",
        },
        "velocity_axes": {"load_phase": "table_phase"},
    },
}


def hint(fmu: str, variable: str) -> str:
    """The end of a message about a variable that an FMU no longer has; else empty."""
    for version, fmus in RENAMED.items():
        if new := fmus.get(fmu, {}).get(variable):
            return f"; since {version} it is {new!r}"
    return ""
