#!/usr/bin/env python3
"""Draws the figures of docs/results/index.md from the tables of the pages beside it. Needs matplotlib.

usage: docs/results/figures.py [--check]

--check     exit code 1 where a table has changed since its figure was drawn (needs no matplotlib)
"""
import hashlib
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
BLUE, ORANGE, GREEN, GREY, PINK = "#0072b2", "#e69f00", "#009e73", "#999999", "#cc79a7"  # told apart by all eyes


def table(page, first_cells, after=""):
    """Rows (dicts by column) of the first table behind a text of a page whose header begins with these cells."""
    text = (HERE / page).read_text()
    lines = text[text.index(after):].splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("| " + " | ".join(first_cells)))
    rows = [[cell.strip(" *") for cell in line.strip().strip("|").split("|")] for line in lines[begin:]]
    end = next((i for i, line in enumerate(lines[begin:]) if not line.startswith("|")), len(rows))
    return [dict(zip(rows[0], row)) for row in rows[2:end]]


def number(cell):
    """The first number of a cell; None for a dash."""
    found = re.match(r"[\d.]+", cell)
    return float(found[0]) if found else None


def real_clips():
    runs = {}
    for row in table("accuracy.md", ["recording", "seconds", "method"]):
        runs.setdefault((row["recording"], row["method"]), []).append(number(row["ATE cm"]))
    names = list(dict.fromkeys(recording for recording, _ in runs))
    mean = lambda method: [sum(runs[name, method]) / len(runs[name, method]) for name in names]
    return names, {"EVIT": (BLUE, mean("EVIT")), "EVT, events only": (ORANGE, mean("EVT"))}


def simulation():
    rows = [row for part in ("## Table I: ", "## Table II: ") for row in table("paper.md", ["Sequence", "Method"], part)]
    names = list(dict.fromkeys(row["Sequence"] for row in rows))
    of = lambda method, rate: [next(number(row["100 % Pos."]) for row in rows
                                    if (row["Sequence"], row["Method"], row["Frequency"]) == (name, method, rate))
                               for name in names]
    return names, {"EVIT": (BLUE, of("EVIT", "(dyn)")), "EVT, 300 Hz": (ORANGE, of("EVT", "300hz")),
                   "EVT, 100 Hz": (PINK, of("EVT", "100hz")), "EVPT": (GREY, of("EVPT", "(dyn)"))}


def same_clips():
    rows = table("comparison.md", ["clip", "EVIT"])
    column = lambda name: [number(row[name]) for row in rows]
    return [row["clip"] for row in rows], {
        "EVIT": (BLUE, column("EVIT")), "EVIT, no start pose": (GREEN, column("EVIT, started without a pose")),
        "EVT": (ORANGE, column("EVT")), "authors' code, tuned per clip": (GREY, column("authors' code"))}


def published():
    rows = table("comparison.md", ["sequence", "EVIT, paper"])
    column = lambda name: [number(row[name]) for row in rows]
    return [row["sequence"] for row in rows], {
        "EVIT, paper": (BLUE, column("EVIT, paper")), "Canny-EVT, 300 Hz": (ORANGE, column("Canny-EVT at 300 Hz")),
        "ESVO2": (GREEN, column("ESVO2")), "DEIO": (PINK, column("DEIO"))}


FIGURES = {  # file: panels of (title, data, logarithmic, what a bar that is missing means)
    "real-clips.svg": [("Real recordings: position error in the map frame, mean of all starts", real_clips, False, "lost")],
    "simulation.svg": [("Simulation: position error, median of three rooms, paper's alignment", simulation, True, "lost")],
    "peers.svg": [("The same real clips, not aligned", same_clips, False, "lost"),
                  ("Published, whole sequences; alignments differ", published, True, "none")],
}


def bars(axes, title, names, series, logarithmic, missing):
    width = 0.8 / len(series)
    least = 0.1 if logarithmic else 0
    for k, (label, (colour, values)) in enumerate(series.items()):
        at = [i + (k - (len(series) - 1) / 2) * width for i in range(len(names))]
        axes.bar(at, [value or least for value in values], width, color=colour, label=label)
        for x, value in zip(at, values):
            axes.annotate(f"{value:.2f}" if value else missing, (x, value or least), xytext=(0, 2),
                          textcoords="offset points", ha="center", va="bottom", fontsize=10, rotation=90)
    axes.set_title(title, fontsize=13, pad=28)
    axes.set_ylabel("position error, cm", fontsize=12)
    axes.set_xticks(range(len(names)), [name.replace("_", "\n", 1) for name in names], fontsize=12)
    if logarithmic:
        axes.set_yscale("log")
        axes.set_yticks([0.1, 0.3, 1, 3, 10, 30], ["0.1", "0.3", "1", "3", "10", "30"], minor=False)
        axes.minorticks_off()
        axes.set_ylim(least, 3 * max(value or 0 for _, values in series.values() for value in values))
    else:
        axes.set_ylim(0, 1.25 * max(value or 0 for _, values in series.values() for value in values))
    axes.grid(axis="y", color="0.9")
    axes.set_axisbelow(True)
    axes.legend(fontsize=11, frameon=False, ncols=len(series), loc="lower center", bbox_to_anchor=(0.5, 0.99),
                columnspacing=1, handlelength=1, handletextpad=0.4)
    axes.spines[["top", "right"]].set_visible(False)


def digest(panels):
    return hashlib.sha256(repr([(panel[0], panel[1]()) for panel in panels]).encode()).hexdigest()[:16]


def draw(name, panels):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = name
    import matplotlib.pyplot as plt
    figure, grid = plt.subplots(1, len(panels), figsize=(6.8 * len(panels) if len(panels) > 1 else 9, 4.2), squeeze=False)
    for axes, (title, data, logarithmic, missing) in zip(grid[0], panels):
        bars(axes, title, *data(), logarithmic, missing)
    figure.tight_layout()
    figure.savefig(HERE / name, metadata={"Date": None, "Description": "tables " + digest(panels)})


def main():
    stale = [name for name, panels in FIGURES.items()
             if not (HERE / name).exists() or "tables " + digest(panels) not in (HERE / name).read_text()]
    if sys.argv[1:] == ["--check"]:
        for name in stale:
            print(f"docs/results/{name} shows other figures than its tables: docs/results/figures.py")
        sys.exit(1 if stale else 0)
    if sys.argv[1:]:
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1] in ("-h", "--help") else 1)
    for name, panels in FIGURES.items():
        draw(name, panels)


if __name__ == "__main__":
    main()
