#!/usr/bin/env python3
"""Writes the camera path of the demo: 60 s from 12,000 km down into the Sierra Nevada, then 60 s low along its crest.

Usage: make_tour.py > tour.csv     (Python's standard library alone)

The camera looks at a point on the ground that slides from the Pacific off Mexico to the crest while the height falls by
the same share every second but for the ends, where it eases in and out; then the camera flies north-west along the
crest at 4,700 m above the ellipsoid and winds a little, as a pilot would.
"""
import math

DESCENT_S = 60
LOW_S = 60
TOP_M = 12_000e3
LOW_M = 4_700.0
GROUND_M = 2_600.0           # about the ground that the camera looks at in the end
SPACE_LOOK = (22.0, -112.0)  # latitude and longitude looked at from space
CREST_LOOK = (36.80, -118.33)
CREST_HEADING_DEG = 330.0
LOW_PITCH_DEG = -14.0
LOW_SPEED_MPS = 330.0
EARTH_RADIUS_M = 6_371_000.0


def ease(share):
    """0 to 1 with no speed and no acceleration at either end."""
    share = min(max(share, 0.0), 1.0)
    return share**3 * (share * (6 * share - 15) + 10)


def offset(latitude, longitude, heading_deg, distance_m):
    """The place `distance_m` along a great circle."""
    angle = distance_m / EARTH_RADIUS_M
    lat, heading = math.radians(latitude), math.radians(heading_deg)
    to_lat = math.asin(math.sin(lat) * math.cos(angle) + math.cos(lat) * math.sin(angle) * math.cos(heading))
    to_lon = math.radians(longitude) + math.atan2(math.sin(heading) * math.sin(angle) * math.cos(lat),
                                                  math.cos(angle) - math.sin(lat) * math.sin(to_lat))
    return math.degrees(to_lat), math.degrees(to_lon)


def descent(t):
    height = TOP_M * (LOW_M / TOP_M) ** ease(t / DESCENT_S)
    slide = ease(t / (0.75 * DESCENT_S))
    look = [a + (b - a) * slide for a, b in zip(SPACE_LOOK, CREST_LOOK)]
    level = ease((t - 0.45 * DESCENT_S) / (0.55 * DESCENT_S))
    pitch = -90.0 + (LOW_PITCH_DEG + 90.0) * level
    heading = CREST_HEADING_DEG * ease(t / DESCENT_S) - 360.0 * ease(t / DESCENT_S)
    behind = (height - GROUND_M * level) / math.tan(math.radians(-pitch)) if level > 0 else 0.0
    lat, lon = offset(look[0], look[1], heading + 180.0, behind)
    return lat, lon, height, heading % 360.0, pitch, 0.0


def low(t, start):
    """One second after another from `start`, so that the place is the sum of the speeds."""
    lat, lon = start
    steps = 50
    for step in range(int(round((t - DESCENT_S) * steps))):
        now = step / steps
        speed = LOW_SPEED_MPS * ease(now / 8.0)
        lat, lon = offset(lat, lon, winding(now), speed / steps)
    now = t - DESCENT_S
    height = LOW_M + 150.0 * math.sin(math.pi * now / LOW_S) ** 2
    bank = 2.2 * (winding(now + 0.5) - winding(now - 0.5)) * ease(now / 8.0)
    return lat, lon, height, winding(now) % 360.0, LOW_PITCH_DEG, bank


def winding(now):
    return CREST_HEADING_DEG + 14.0 * math.sin(2 * math.pi * now / 30.0) * ease(now / 15.0)


def main():
    print("t_s,lat_deg,lon_deg,height_m,heading_deg,pitch_deg,roll_deg,vfov_deg")
    start = descent(DESCENT_S)[:2]
    for t in range(DESCENT_S + LOW_S + 1):
        lat, lon, height, heading, pitch, roll = descent(t) if t <= DESCENT_S else low(t, start)
        print(f"{t},{lat:.6f},{lon:.6f},{height:.2f},{heading:.4f},{pitch:.4f},{roll:.4f},60")


if __name__ == "__main__":
    main()
