"""Constants of the lessons, in SI units, and how a row of a table is printed."""

G = 9.81
GRAVITY = 6.674e-11
SUN = 1.989e30
EARTH = 5.972e24
EARTH_RADIUS = 6.371e6


def row(*cells: str) -> str:
    return " | ".join(cells)
