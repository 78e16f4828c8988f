#!/usr/bin/env python3
"""Draws who includes whom in nodes/, from the #include lines, into launch/pictures/rooms.png. Each room stands above
all that it includes. The picture carries its edges as text, by which pages_test.py sees that it is of today."""
import pathlib
import struct

import rooms_test

PICTURE = rooms_test.NODES.parent / "launch" / "pictures" / "rooms.png"
KEY = "Comment"


def edges_of(nodes):
    """The edges as one text."""
    return ", ".join(f"{start}>{end}" for start, end in sorted(rooms_test.edges(nodes)))


def edges_in(picture):
    """The text that write() put into a PNG; empty where there is none."""
    data, at = pathlib.Path(picture).read_bytes(), 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"tEXt":
            key, _, text = data[at + 8:at + 8 + size].partition(b"\0")
            if key.decode() == KEY:
                return text.decode()
        at += 12 + size
    return ""


def levels(pairs):
    """Room: how many rooms lie below it, one including the next."""
    rooms = {room for pair in pairs for room in pair}
    level = dict.fromkeys(rooms, 0)
    for _ in rooms:
        for start, end in pairs:
            level[start] = max(level[start], level[end] + 1)
    return level


def implied(pair, pairs):
    """Is there a longer way from one to the other?"""
    left, seen = [end for start, end in pairs if start == pair[0] and end != pair[1]], set()
    while left:
        room = left.pop()
        if room == pair[1]:
            return True
        if room not in seen:
            seen.add(room)
            left += [end for start, end in pairs if start == room]
    return False


def write(path, nodes=rooms_test.NODES):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    pairs = sorted(rooms_test.edges(nodes))
    level = levels(pairs)
    place = {}
    for height in sorted(set(level.values()), reverse=True):  # below the middle of those that include it
        def above(room):
            return [place[start][0] for start, end in pairs if end == room and start in place and not implied((start, end), pairs)]
        row = sorted((room for room in level if level[room] == height),
                     key=lambda room: (sum(above(room)) / max(1, len(above(room))), room))
        for i, room in enumerate(row):
            x = 2.3 * (i - (len(row) - 1) / 2)
            place[room] = (x + (0.6 if height % 2 else -0.6) * (len(row) == 1), 1.25 * height)
    width = max(x for x, _ in place.values()) - min(x for x, _ in place.values()) + 2.6
    figure = pyplot.figure(figsize=(max(8, 0.95 * width), 1.2 * (max(level.values()) + 1)))
    axes = figure.add_axes((0, 0, 1, 1))
    box = {room: axes.text(x, y, room, ha="center", va="center", fontsize=12, zorder=2,
                           bbox={"boxstyle": "round,pad=0.45", "fc": "#e8f0f8", "ec": "#30506f"})
           for room, (x, y) in place.items()}
    axes.set_xlim(min(x for x, _ in place.values()) - 1.3, max(x for x, _ in place.values()) + 1.3)
    axes.set_ylim(-0.6, 1.25 * max(level.values()) + 0.6)
    axes.axis("off")
    figure.canvas.draw()  # boxes know their sizes from now on
    size = {room: axes.transData.inverted().transform(text.get_bbox_patch().get_window_extent()) for room, text in box.items()}

    def border(room, other):
        """Where the way from the middle of one box to that of another leaves it."""
        (left, low), (right, high) = size[room]
        x, y = place[room]
        dx, dy = place[other][0] - x, place[other][1] - y
        share = min((right - left) / 2 / abs(dx) if dx else 1, (high - low) / 2 / abs(dy) if dy else 1)
        return x + share * dx, y + share * dy

    for pair in sorted(pairs, key=lambda pair: not implied(pair, pairs)):
        far = implied(pair, pairs)
        axes.annotate("", xy=border(pair[1], pair[0]), xytext=border(*pair), zorder=1,
                      arrowprops={"arrowstyle": "->", "color": "0.82" if far else "0.25", "lw": 0.8 if far else 1.4,
                                  "shrinkA": 0, "shrinkB": 1})
    figure.savefig(path, dpi=110, metadata={KEY: edges_of(nodes), "Software": None})


if __name__ == "__main__":
    write(PICTURE)
