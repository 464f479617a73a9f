"""The chart of what solids cost: figures of bench/solids.py."""

from pathlib import Path

from verification.report.charts import BLUE, DARK, GREY, figure_of

SUSPENSIONS = {"13_2d": "discs, 13 %", "13_3d": "spheres, 13 %", "dense_2d": "discs, 70 %, in contact",
               "dense_3d": "spheres, 55 %, in contact", "sizes_2d": "discs, radii 1:10", "sizes_3d": "spheres, radii 1:10"}
GOAL = 0.1  # share of solids at a fraction of 13 %


def costs_of_solids(figures: dict[str, float], file: Path) -> None:
    """Shares of a step on one process, and what a PP costs beside one of the fluid alone."""
    rows = range(len(SUSPENSIONS))
    with figure_of(file, 9, 3.2, columns=2) as (shares, costs):
        kinds = {"share_solids": ("solids and their copies", BLUE), "share_frozen_pairs": ("pairs of PPs and FPs", GREY)}
        passed = [0.0 for _ in rows]
        for kind, (words, color) in kinds.items():
            values = [100 * figures[f"ratio {name}.{kind}"] for name in SUSPENSIONS]
            shares.barh(rows, values, 0.6, left=passed, color=color, label=words)
            passed = [before + value for before, value in zip(passed, values, strict=True)]
        for row, name in enumerate(SUSPENSIONS):
            share = 100 * figures[f"ratio {name}.share_solids"]
            shares.annotate(f"{share:.2g} %", (passed[row], row), (4, 0), textcoords="offset points", va="center", fontsize=8,
                            color=BLUE, bbox={"color": "white", "pad": 1})
        shares.axvline(100 * GOAL, color=DARK, linewidth=1, zorder=0, label="goal at 13 %")
        shares.set_yticks(rows, SUSPENSIONS.values())
        shares.set_xlim(0, 1.12 * max(passed))
        shares.set_xlabel("per cent of a step")
        shares.legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
        for ranks, color, side in ((1, BLUE, -0.18), (2, GREY, 0.18)):
            values = [figures[f"ratio {name}.cost_per_pp_over_fluid_{ranks}"] for name in SUSPENSIONS]
            costs.barh([row + side for row in rows], values, 0.34, color=color, label={1: "one process", 2: "two"}[ranks])
            for row, value in zip(rows, values, strict=True):
                costs.text(value, row + side, f" {value:.2g}", va="center", fontsize=7)
        costs.axvline(1.0, color=DARK, linewidth=1)
        costs.set_yticks(rows, [])
        costs.set_xlabel("cost of a PP over one of the fluid alone")
        costs.legend(frameon=False, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
        for axes in (shares, costs):
            axes.invert_yaxis()
            axes.grid(axis="y", visible=False)
