"""What a study is: a scenario at many points, run by workers, its rows kept."""
