#!/usr/bin/python3
"""Checks pictures of an engine with growth in its pass. Usage: check_pictures.py FOLDER

The pictures are of one view: the engine alone (plain), with ivy, with brighter ivy, both without the object that stands in front,
and with the ivy's shadow, if the engine has any. Pixels that differ between ivy and brighter ivy are ivy's; all others are the
engine's.
"""
import os
import sys

import numpy
from PIL import Image

folder = sys.argv[1]
failed = False


def read(name):
    return numpy.asarray(Image.open(f"{folder}/{name}.png").convert("RGB")).astype(int)


def differ(a, b):
    return (a != b).any(axis=2)


def check(what, value, holds):
    global failed
    failed |= not holds
    print(f"  {'ok  ' if holds else 'FAIL'} {what}: {value}")


plain, ivy, bright = read("plain"), read("ivy"), read("bright_ivy")
bare, overgrown = read("plain_without_object"), read("ivy_without_object")

ivys = differ(ivy, bright)
check("ivy's share of the picture", f"{ivys.mean():.3f}", ivys.mean() >= 0.05)
changed = (differ(ivy, plain) & ~ivys).sum()
check("pixels of the engine's own that changed", changed, changed == 0)

inside = differ(plain, bare)
for _ in range(2):  # its edge may be smoothed
    inside[1:-1, 1:-1] &= inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
behind = (differ(overgrown, bare) & inside).sum()
check("pixels of ivy behind the engine's object", behind, behind >= 500)
shining = (differ(ivy, plain) & inside).sum()
check("pixels of the object that ivy covers", shining, shining == 0)

if not os.path.exists(f"{folder}/shadow_alone.png"):
    sys.exit(failed)
shaded = read("shadow_alone")
light, dark = bare.sum(axis=2), shaded.sum(axis=2)
darker = ((dark <= 0.9 * light) & ~differ(overgrown, bare)).mean()
check("share of the picture, outside of ivy, that ivy's shadow darkens by 10 %", f"{darker:.3f}", darker >= 0.005)
sys.exit(failed)
