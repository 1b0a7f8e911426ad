"""Names of a contour's numbers in words, with their units."""

# Dotted name of a number, what it is, its unit: mm for lengths, which are shown in µm or mm.
CONTOUR = [
    ("error.max", "Contour error, largest", "mm"),
    ("error.rms", "Contour error, RMS", "mm"),
    ("error.p50", "Contour error, median", "mm"),
    ("error.p95", "Contour error, 95 %", "mm"),
    ("command_error.max", "Command error, largest", "mm"),
    ("command_error.rms", "Command error, RMS", "mm"),
    *((f"following.{a}.max", f"Following error {a.upper()}, largest", "mm") for a in "xyzuvw"),
    *((f"following.{a}.rms", f"Following error {a.upper()}, RMS", "mm") for a in "xyzuvw"),
    ("lag", "Servo lag", "s"),
]
WAYS = (("ccw", "counter-clockwise"), ("cw", "clockwise"))
CIRCLE = [
    ("both.g", "G(b), both ways", "mm"),
    ("both.d", "D, both ways", "mm"),
    *(
        (f"{way}.{name}", f"{title}, {words}", unit)
        for name, title, unit in (
            ("g", "G", "mm"),
            ("f_max", "F max", "mm"),
            ("f_min", "F min", "mm"),
            ("radius_change", "Radius change", "mm"),
            ("major_change", "Major semi-axis", "mm"),
            ("minor_change", "Minor semi-axis", "mm"),
            ("orientation", "Ellipse direction", "rad"),
            ("speed", "Speed", "mm/s"),
        )
        for way, words in WAYS
    ),
]
CIRCLES, CORNERS = "circles", "corners"


def in_words(name: str) -> tuple[str, str]:
    """A number of the contour by its dotted name: what it is, and its unit; empty if unknown."""
    head, _, rest = name.partition(".")
    place, _, own = rest.partition(".")
    if head == CIRCLES:
        found = {n: (f"Circle {int(place) + 1}: {title}", unit) for n, title, unit in CIRCLE}
        return found.get(own, ("", ""))
    if head == CORNERS:
        title = {"error": "contour error", "speed": "least speed", "angle": "change of direction"}
        unit = {"error": "mm", "speed": "mm/s", "angle": "rad"}
        return (f"Corner {int(place) + 1}: {title[own]}", unit[own]) if own in title else ("", "")
    return {n: (title, unit) for n, title, unit in CONTOUR}.get(name, ("", ""))
