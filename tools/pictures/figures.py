#!/usr/bin/env python3
"""Draws the figures of the documents as SVG: figures.py OUT. The same bytes every time; nothing but the standard library."""

import argparse
import math
import pathlib
from xml.sax.saxutils import escape

INK, GREY, PALE, FAINT = "#1f2933", "#66717d", "#c9d1d9", "#eef1f4"
BLUE, RED, GREEN, AMBER, VIOLET = "#1565c0", "#c62828", "#2e7d32", "#b26a00", "#6a3fb5"
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"


class Drawing:
    """An SVG on white, so that it can be read on a dark page too. Lengths in pixels, y downwards."""

    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.items = width, height, title, []

    def add(self, tag, text=None, **attributes):
        words = "".join(f' {key.replace("_", "-")}="{escape(self.write(value), {chr(34): "&quot;"})}"'
                        for key, value in attributes.items() if value is not None)
        self.items.append(f"<{tag}{words}/>" if text is None else f"<{tag}{words}>{text}</{tag}>")

    @staticmethod
    def write(value):
        return f"{value:.2f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)

    def line(self, points, color=INK, width=1.6, dash=None, head=None, fill="none", closed=False):
        path = " ".join(f"{'M' if k == 0 else 'L'}{x:.1f} {y:.1f}" for k, (x, y) in enumerate(points))
        self.add("path", d=path + (" Z" if closed else ""), fill=fill, stroke=color, stroke_width=width,
                 stroke_dasharray=dash, stroke_linejoin="round")
        if head is not None:
            (x0, y0), (x1, y1) = points[-2:]
            self.head(x1, y1, math.atan2(y1 - y0, x1 - x0), color, head)

    def head(self, x, y, angle, color, size):
        corner = [(x, y)] + [(x - size * math.cos(angle + s * 0.42), y - size * math.sin(angle + s * 0.42)) for s in (1, -1)]
        self.add("path", d="M" + " L".join(f"{a:.1f} {b:.1f}" for a, b in corner) + " Z", fill=color, stroke="none")

    def arrow(self, x0, y0, x1, y1, color=INK, width=1.6, dash=None, size=9):
        self.line([(x0, y0), (x1, y1)], color, width, dash, head=size)

    def curve(self, start, control, end, color=INK, width=1.6, size=9):
        self.add("path", d=f"M{start[0]:.1f} {start[1]:.1f} Q{control[0]:.1f} {control[1]:.1f} {end[0]:.1f} {end[1]:.1f}",
                 fill="none", stroke=color, stroke_width=width)
        self.head(*end, math.atan2(end[1] - control[1], end[0] - control[0]), color, size)

    def circle(self, x, y, radius, color=INK, fill="none", width=1.6, dash=None):
        self.add("circle", cx=x, cy=y, r=radius, fill=fill, stroke=color, stroke_width=width, stroke_dasharray=dash)

    def box(self, x, y, width, height, fill="white", color=INK, radius=6, dash=None, line=1.6):
        self.add("rect", x=x, y=y, width=width, height=height, rx=radius, fill=fill, stroke=color, stroke_width=line,
                 stroke_dasharray=dash)

    def text(self, x, y, words, size=14, color=INK, anchor="start", weight=None, style=None):
        """`_` before a word in braces makes it an index: X_{WB}."""
        spans, rest = [], words
        while "_{" in rest:
            before, _, rest = rest.partition("_{")
            index, _, rest = rest.partition("}")
            spans.append(escape(before) + f'<tspan baseline-shift="sub" font-size="{size * 0.75:.1f}">{escape(index)}</tspan>')
        self.add("text", "".join(spans) + escape(rest), x=x, y=y, font_size=size, fill=color, text_anchor=anchor,
                 font_weight=weight, font_style=style)

    def lines(self, x, y, all_words, size=13, color=INK, anchor="start", step=None):
        for k, words in enumerate(all_words):
            self.text(x, y + k * (step or size * 1.35), words, size, color, anchor)

    def frame(self, x, y, name, color, turn=0.0, length=34, at=(-16, 18)):
        """A right-handed frame seen from the side: x to the right, z up, turned by `turn` [rad]."""
        c, s = math.cos(turn), math.sin(turn)
        self.arrow(x, y, x + length * c, y - length * s, color, 2.2, size=8)
        self.arrow(x, y, x - length * s, y - length * c, color, 2.2, size=8)
        self.circle(x, y, 3.2, color, color)
        self.text(x + at[0], y + at[1], name, 16, color, "middle", "bold")

    def __str__(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                f'height="{self.height}" font-family="{FONT}" role="img">')
        back = f'<rect width="{self.width}" height="{self.height}" rx="8" fill="white"/>'
        return "\n".join([head, f"<title>{escape(self.title)}</title>", back, *self.items, "</svg>"]) + "\n"


def turned(x, y, turn, points):
    """Points of a body at (x, y), turned by `turn`, from its own coordinates (x right, z up)."""
    c, s = math.cos(turn), math.sin(turn)
    return [(x + c * a - s * b, y - s * a - c * b) for a, b in points]


def draw_frames():
    d = Drawing(980, 470, "The frames of the device D and H, of the scene W, and of the parts B, T and D")
    d.text(24, 34, "The device, in the hand", 15, GREY, weight="bold")
    d.text(330, 34, "The scene", 15, GREY, weight="bold")
    d.line([(300, 20), (300, 450)], PALE, 1.2, "5 5")
    # The device: a base, two links, a handle.
    d.box(50, 350, 110, 44, FAINT, GREY)
    d.line([(105, 350), (75, 245), (190, 190)], GREY, 9)
    d.line([(105, 350), (75, 245), (190, 190)], "white", 5)
    d.circle(75, 245, 7, GREY, "white")
    d.line([(190, 190), (236, 150)], GREY, 7)
    d.frame(105, 350, "D", BLUE, 0, 40, (-20, -8))
    d.lines(50, 416, ["base of the device, with its", "maker's axes (device/)"], 12, GREY)
    d.frame(190, 190, "H", AMBER, 0.3, 40, (-4, 26))
    d.lines(60, 92, ["H: the hand's point on the handle", "X_{DH}: what the device measures"], 12, AMBER)
    # W, and the way from the device's base to the scene.
    d.frame(350, 400, "W", INK, 0, 46, (-18, 16))
    d.lines(330, 440, ["world: z up, origin as in the file"], 12, GREY)
    # A placed part with a pocket, and its frame B.
    outline = [(-120, 0), (120, 0), (120, 70), (38, 70), (38, 26), (-38, 26), (-38, 70), (-120, 70)]
    d.line(turned(640, 400, 0, outline), GREY, 1.6, fill=FAINT, closed=True)
    d.frame(548, 386, "B", GREEN, 0, 34, (-13, -8))
    d.text(640, 424, "a part in its place, X_{WB}", 12, GREEN, "middle")
    d.curve((398, 404), (470, 436), (540, 392), GREEN, 1.4)
    # The tracked part goes through the wall; the displayed one stays before it.
    peg = [(-30, 0), (30, 0), (30, 92), (-30, 92)]
    shown, tracked = (652, 330, 0.0), (694, 292, -0.22)
    d.line(turned(*tracked, peg), AMBER, 1.6, "6 4", closed=True)
    d.line(turned(*shown, peg), BLUE, 1.8, fill="#e3eefb", closed=True)
    d.frame(652, 312, "D", BLUE, 0.0, 34, (-16, 10))
    d.frame(700, 264, "T", AMBER, -0.22, 34, (0, 22))
    # The spring between the two.
    spring = [(660, 303)]
    for k in range(9):
        spring.append((663 + 4 * k + (-3 if k % 2 else 3), 300 - 3.6 * k + (-4 if k % 2 else 4)))
    spring.append((698, 268))
    d.line(spring, RED, 1.6)
    d.lines(778, 216, ["T: the tracked part, where", "the hand has it", "X_{WT} = X_{WH} X_{HB}"], 12, AMBER)
    d.lines(778, 318, ["coupling: spring and damper", "from D to T; its wrench is", "what the hand feels"], 12, RED)
    d.arrow(772, 314, 694, 290, RED, 1.0, size=6)
    d.lines(430, 214, ["D: the displayed part, where it", "can be; contact and mates", "hold it, X_{WD}"], 12, BLUE)
    d.arrow(574, 240, 616, 262, BLUE, 1.0, size=6)
    # H in the scene.
    d.frame(640, 120, "H", AMBER, 0.3, 34, (-4, 24))
    d.curve((244, 146), (430, 60), (624, 112), AMBER, 1.4)
    d.text(352, 72, "X_{WH}: moved into the scene, lengths scaled", 12, AMBER)
    d.curve((660, 128), (736, 160), (712, 246), AMBER, 1.4)
    d.lines(752, 142, ["X_{HB}: the grip, fixed", "when the part is taken"], 12, AMBER)
    return d


def draw_states():
    d = Drawing(900, 300, "The states of a held part: empty, free, near, captured, mating, seated")
    names = [("empty", "nothing in", "the hand", GREY), ("free", "no mate", "in range", INK), ("near", "within 3 times the", "capture limits", INK),
             ("captured", "a spring draws it", "onto the axis", AMBER), ("mating", "the fit answers,", "not contact", BLUE),
             ("seated", "moves exactly", "into place", GREEN)]
    width, height, gap, top = 108, 64, 38, 104
    left = [20 + k * (width + gap) for k in range(6)]
    for (name, first, second, color), x in zip(names, left):
        d.box(x, top, width, height, "white", color, 10, line=2.2)
        d.text(x + width / 2, top + 24, name, 16, color, "middle", "bold")
        d.lines(x + width / 2, top + 42, [first, second], 10.5, GREY, "middle", 14)
    over = ["taken", "a mate\ncomes near", "inside\nthe limits", "ramp done,\naligned", "at the\ngoal"]
    for k, words in enumerate(over):
        x0, x1 = left[k] + width + 3, left[k + 1] - 3
        d.arrow(x0, top + 22, x1, top + 22, INK, 1.8, size=8)
        lines = words.split("\n")
        d.lines((x0 + x1) / 2, top - 30 + 14 * (2 - len(lines)), lines, 11, INK, "middle", 14)
    for k in (1, 2, 3):
        d.arrow(left[k + 1] - 3, top + 46, left[k] + width + 3, top + 46, GREY, 1.4, size=7)
    y = top + height
    d.curve((left[3] + 54, y + 3), ((left[1] + left[3]) / 2 + 54, y + 70), (left[1] + 54, y + 4), GREY, 1.4, 8)
    d.text((left[1] + left[3]) / 2 + 54, y + 56, "beyond 1.5 times the limits", 11, GREY, "middle")
    d.line([(left[5] + 54, y + 3), (left[5] + 54, y + 92), (left[0] + 54, y + 92), (left[0] + 54, y + 6)], GREEN, 1.6, head=9)
    d.text((left[2] + left[3] + width) / 2, y + 110, "let go: a seated part stays in its place; any other falls, or stays where its fits hold it", 12, GREEN, "middle")
    d.text(20, 34, "States of a held part (haptics::HoldState)", 15, GREY, weight="bold")
    return d


def draw_tick():
    d = Drawing(900, 650, "The order inside a tick, and what goes between the three loops")
    d.text(24, 34, "Haptic loop: 1 kHz (to 8 kHz)", 15, BLUE, weight="bold")
    d.text(628, 34, "Other loops", 15, GREY, weight="bold")
    steps = [("1", "Device state", "refused when not valid or not finite: the force goes"),
             ("2", "Workspace", "handle to hand: border, clutch, regrasp; tracked pose T"),
             ("3", "Mates", "captured and released on the displayed pose D"),
             ("4", "One implicit step of the part", "coupling, weight, mates, fits, contacts, friction"),
             ("5", "Displayed pose D", "felt wrench = coupling's; the true wrench is kept beside it"),
             ("6", "State of the hold", "free, near, captured, mating, seated"),
             ("7", "Wrench in the device's base", "border spring; torque as a cue where there is none"),
             ("8", "Passivity control", "with a device that shows forces"),
             ("9", "Safety gate", "finite, dead-man, thermal, norm, slew: last before the device")]
    x, y, width, height, pitch = 110, 56, 430, 46, 57
    for k, (number, name, what) in enumerate(steps):
        top = y + k * pitch
        color = RED if number in "89" else BLUE
        d.box(x, top, width, height, "white", color, 7)
        d.text(x + 18, top + 29, number, 15, color, "middle", "bold")
        d.text(x + 36, top + 19, name, 13.5, INK, weight="bold")
        d.text(x + 36, top + 37, what, 12, GREY)
        if k:
            d.arrow(x + width / 2, top - pitch + height, x + width / 2, top - 2, INK, 1.4, size=7)
    end = y + 8 * pitch + height
    d.box(20, y, 66, 46, FAINT, INK, 7)
    d.text(53, y + 28, "Read", 13, INK, "middle")
    d.arrow(86, y + 23, x - 3, y + 23, INK, 1.6, size=8)
    d.box(20, end - 46, 66, 46, FAINT, INK, 7)
    d.text(53, end - 18, "Write", 13, INK, "middle")
    d.arrow(x, end - 23, 89, end - 23, INK, 1.6, size=8)
    d.line([(53, end - 48), (53, y + 48)], GREY, 1.4, "5 4", head=8)
    d.add("text", "hand and device", x=46, y=float((y + end) / 2), font_size=12, fill=GREY, text_anchor="middle",
          transform=f"rotate(-90 46 {(y + end) / 2:.0f})")
    d.text(x + width / 2, end + 30, "no allocation, lock, exception or output in any of this", 12, BLUE, "middle")
    boxes = [(y + 20, "Physics loop, 100 Hz", ["takes up and lets go,", "keeps account of loose parts"], INK),
             (y + 218, "Publish loop, 30 Hz", ["frames for whoever watches", "(60 Hz in the studio)"], INK),
             (8 * pitch + y + 23 - 42, "Recorder", ["writes ticks, events and", "commands into SQLite"], INK)]
    right = 640
    for top, name, what, color in boxes:
        d.box(right, top, 236, 84, "white", color, 7)
        d.text(right + 16, top + 26, name, 13.5, color, weight="bold")
        d.lines(right + 16, top + 48, what, 12, GREY, step=18)
    first, second, third = (top for top, *_ in boxes)
    d.arrow(right, first + 26, x + width + 4, first + 26, INK, 1.4, size=7)
    d.text((right + x + width) / 2, first + 19, "commands", 11, GREY, "middle")
    d.arrow(x + width, first + 62, right - 3, first + 62, INK, 1.4, size=7)
    d.text((right + x + width) / 2, first + 78, "events, poses", 11, GREY, "middle")
    d.arrow(right + 118, first + 84, right + 118, second - 3, INK, 1.4, size=7)
    d.lines(right + 128, (first + 84 + second) / 2 - 2, ["newest poses"], 11, GREY)
    d.arrow(x + width, third + 42, right - 3, third + 42, INK, 1.4, size=7)
    d.text((right + x + width) / 2, third + 35, "ticks", 11, GREY, "middle")
    d.lines(right, end + 44, ["Arrows are rings and triple buffers:", "no loop waits for another."], 12, GREY, step=18)
    return d


def draw_field():
    d = Drawing(960, 420, "The signed distance field of one part and the point shell of another")
    d.text(24, 34, "Signed distance field of the part below: distance to its surface, negative inside", 14, BLUE, weight="bold")
    d.text(24, 56, "Point shell of the held part above: samples on its surface, asked in the field", 14, AMBER, weight="bold")
    surface, left, right, bottom = 290, 30, 590, 396
    for k in range(-5, 8):
        height = surface - 16 * k
        if height > 88 and height < bottom:
            shade = PALE if k else BLUE
            d.line([(left, height), (right, height)], shade, 2.4 if k == 0 else 1.0, None if k >= 0 else "4 4")
    d.add("rect", x=left, y=surface, width=right - left, height=bottom - surface, fill="#e3eefb", opacity="0.6")
    for k in range(35):  # the cells of the grid near the surface
        for row in (0, 1):
            d.box(left + 16 * k, surface - 16 + 16 * row, 16, 16, "none", "#9db7d5", 0, line=0.7)
    for value, k in (("+48 µm", 3), ("+16 µm", 1), ("0", 0), ("−16 µm", -1), ("−48 µm", -3)):
        d.text(right + 62, surface - 16 * k + 4, value, 11, BLUE, "end")
    # The held part: a rounded block that sinks in at one end.
    c, s = math.cos(0.09), math.sin(0.09)
    centre, half, tall = (300, 232), 190, 58
    corners = [(-half, -tall), (half, -tall), (half, tall), (-half, tall)]
    place = lambda a, b: (centre[0] + c * a - s * b, centre[1] + s * a + c * b)
    d.line([place(a, b) for a, b in corners], AMBER, 1.8, fill="#fff4de", closed=True)
    d.add("rect", x=left, y=surface, width=right - left, height=1, fill=BLUE, opacity="0.8")
    samples = [(a, tall) for a in range(-half, half + 1, 38)] + [(side * half, b) for side in (-1, 1) for b in (-20, 20, -tall)]
    samples += [(a, -tall) for a in range(-half + 76, half - 75, 76)]
    deepest = None
    for a, b in samples:
        x, y = place(a, b)
        depth = y - surface
        is_near = depth > -20
        d.circle(x, y, 4.6 if is_near else 3.6, RED if depth > 0 else AMBER, RED if depth > 0 else (AMBER if is_near else "white"), 1.6)
        if deepest is None or depth > deepest[2]:
            deepest = (x, y, depth)
    x, y, _ = deepest
    d.arrow(x, surface, x, surface - 46, RED, 2.2, size=9)
    d.text(x - 8, surface - 34, "n", 14, RED, "end", weight="bold", style="italic")
    d.line([(x + 24, surface), (x + 24, y)], RED, 2)
    for level in (surface, y):
        d.line([(x + 18, level), (x + 30, level)], RED, 1.4)
    d.text(x + 36, (surface + y) / 2 + 5, "φ < 0", 13, RED)
    column = 690
    d.line([(column - 14, 84), (column - 14, 396)], PALE, 1.2)
    legend = [(AMBER, "white", "sample further away than the margin:", "passed over by the sphere tree"),
              (AMBER, AMBER, "sample within the margin (60 µm and", "more): a contact that may close"),
              (RED, RED, "sample inside: refined to the exact", "CAD face, 0.5 µm in tests")]
    for k, (color, fill, first, second) in enumerate(legend):
        d.circle(column + 4, 104 + 56 * k, 5, color, fill)
        d.lines(column + 20, 108 + 56 * k, [first, second], 11.5, INK, step=17)
    d.arrow(column + 4, 290, column + 4, 264, RED, 2.2, size=8)
    d.lines(column + 20, 276, ["normal, out of the part that", "is touched"], 11.5, INK, step=17)
    d.lines(column - 2, 330, ["φ: distance, positive for a gap.", "Both ways: the samples of each part", "are asked in the field of the other.", "Not to scale."], 11.5, GREY, step=18)
    return d


FIGURES = {"frames": draw_frames, "states": draw_states, "tick": draw_tick, "contact": draw_field}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    for name, draw in FIGURES.items():
        (out / f"{name}.svg").write_text(str(draw()))


if __name__ == "__main__":
    main()
