# In: a file with a fluid's radius, its box (low and high corner), and a line of x y z and density for each particle. Out: how
# many there are, and by which share of itself a density differs at most from what double precision makes of the places.
# Shares no code with the graph: kernels are written as in papers, and room behind walls is integrated numerically.
import math
import sys

lines = open(sys.argv[1]).read().split("\n")
radius = float(lines[0])
box = list(map(float, lines[1].split()))
particles = [tuple(map(float, line.split())) for line in lines[2:] if line]
mass = (radius / 2) ** 3  # a fluid at rest has density 1, and its particles lie half a radius apart


def share_behind(away):
    """Of the kernel's weight about a place, the share behind a plane that is so far away: Simpson's rule."""
    if away >= radius:
        return 0
    steps = 400
    width = (radius - away) / steps
    # The kernel summed over a plane parallel to the wall at x.
    weight = lambda x: 315 / (256 * radius**9) * (radius**2 - x**2) ** 4
    factors = [1] + [4, 2] * (steps // 2 - 1) + [4, 1]
    return width / 3 * sum(f * weight(away + k * width) for k, f in enumerate(factors))


worst = 0
for *place, given in particles:
    density = 0
    for *other, _ in particles:
        apart = sum((a - b) ** 2 for a, b in zip(place, other))
        if apart < radius**2:
            density += mass * 315 / (64 * math.pi * radius**9) * (radius**2 - apart) ** 3
    inside = 1
    for axis in range(3):
        inside *= 1 - share_behind(place[axis] - box[axis])
        inside *= 1 - share_behind(box[3 + axis] - place[axis])
    density += 1 - inside
    worst = max(worst, abs(given - density) / density)
print(len(particles), worst)
