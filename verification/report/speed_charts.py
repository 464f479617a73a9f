"""Charts of the figures of bench/. Each throws NoFigure where one is missing that it cannot do without."""

from collections.abc import Callable
from pathlib import Path

from verification.report.canvas import BLUE, DARK, ERROR, GREEN, GREY, RED, bars, figure_of
from verification.report.solid_charts import costs_of_solids
from verification.store.figures import Figures, Setting

FLUIDS = {"2d_39": "plane, 39 neighbours", "3d_77": "space, 77 neighbours"}
PALE = "#6f9cc4"
PHASES = {"pairs": BLUE, "lists": PALE, "sort": GREY, "integrate": GREEN, "solids": DARK, "exchange": RED}
CODES = {"mappm": ("MaPPM", BLUE), "without_transport": ("MaPPM, no transport velocity", PALE), "lammps": ("LAMMPS, SPH", DARK),
         "liggghts": ("LIGGGHTS, SPH", GREY)}


def speeds(figures: Figures, file: Path) -> None:
    """Particle-steps a second, and flow time a core-second at the largest useful step of each code, on one process and on two;
    figures of bench/speed.py. The latter is left out where it was not measured."""
    panels = {"particle_steps_per_s": "million particle-steps per second"}
    if figures.where("flow_time_per_core_s"):
        panels["flow_time_per_core_s"] = "million particles times h/c, per core-second"
    with figure_of(file, 5.5 * len(panels), 3.6, columns=len(panels)) as made:
        for panel, (name, words) in zip([made] if len(panels) == 1 else made, panels.items(), strict=True):
            _bars_of_codes(panel, figures, name)
            panel.set_xlabel(words)


def _bars_of_codes(axes, figures: Figures, name: str) -> None:
    """Of codes that were there; MaPPM was."""
    places = {(fluid, ranks): 2 * row + 0.9 * k for row, fluid in enumerate(FLUIDS) for k, ranks in enumerate((1, 2))}
    for fluid, ranks in places:
        figures.value(name, fluid=fluid, code="mappm", ranks=ranks)
    for side, (code, (words, color)) in zip((-0.3, -0.1, 0.1, 0.3), CODES.items(), strict=True):
        rates = {place: figures.get(name, fluid=fluid, code=code, ranks=ranks) for (fluid, ranks), place in places.items()}
        rates = {place: rate / 1e6 for place, rate in rates.items() if rate is not None}
        off = {place: [part / 1e6 for part in figures.off(name, fluid=fluid, code=code, ranks=ranks)]
               for (fluid, ranks), place in places.items()}
        axes.barh([place + side for place in rates], list(rates.values()), 0.19, color=color, label=words if rates else None,
                  xerr=bars([off[place] for place in rates]), error_kw=ERROR)
        for place, rate in rates.items():
            axes.text(rate + off[place][1], place + side, f" {rate:.2g}", va="center", fontsize=7)
    axes.set_yticks(list(places.values()), [f"{FLUIDS[fluid]}, {'one process' if ranks == 1 else 'two'}" for fluid, ranks in places],
                    fontsize=8)
    axes.invert_yaxis()
    axes.margins(x=0.12)


def _ranks_of(figures: Figures, name: str, **settings: Setting) -> list[int]:
    """On how many processes it was measured, one at first; throws NoFigure where not on one."""
    figures.value(name, **settings, ranks=1)
    return sorted({row.settings["ranks"] for row in figures.where(name, **settings)})


def _log2(axes, counts: list[int]) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.set_xlabel("processes")


def scalings(figures: Figures, file: Path) -> None:
    """Efficiency over processes, and the core time of a PP by phase; figures of bench/scaling.py."""
    with figure_of(file, 10, 3.4, columns=2) as (efficiency, phases):
        _efficiencies(efficiency, figures)
        _core_times(phases, figures)


def _efficiencies(axes, figures: Figures) -> None:
    """Over processes; that of one is 1."""
    sets = {("strong", "2d"): ("a million PPs, plane", BLUE, "o-"), ("strong", "3d"): ("half a million, space", GREEN, "s-"),
            ("weak", "2d"): ("100 000 a process, plane", DARK, "^--")}
    for (scaling, fluid), (label, color, style) in sets.items():
        counts = _ranks_of(figures, "particle_steps_per_s", scaling=scaling, fluid=fluid)
        shares = [1.0] + [figures.value("efficiency", scaling=scaling, fluid=fluid, ranks=count) for count in counts[1:]]
        off = [figures.off("efficiency", scaling=scaling, fluid=fluid, ranks=count) for count in counts]
        axes.errorbar(counts, shares, yerr=bars(off), fmt=style, color=color, markersize=4, linewidth=1.2, label=label, **ERROR)
    _log2(axes, counts)
    axes.set_ylim(0, 1.1)
    axes.set_title("efficiency against one process", fontsize=9)


def _core_times(axes, figures: Figures) -> None:
    """Of a PP and step in ns, its phases upon each other, of the fluid that grows with the processes."""
    weak: dict[str, Setting] = {"scaling": "weak", "fluid": "2d"}
    counts = _ranks_of(figures, "particle_steps_per_s", **weak)
    measured = [phase for phase in PHASES if figures.where("microseconds_per_step", **weak, phase=phase)]
    floor = [0.0] * len(counts)
    whole = [count * 1e9 / figures.value("particle_steps_per_s", **weak, ranks=count) for count in counts]
    times = {phase: [figures.value("microseconds_per_step", **weak, ranks=count, phase=phase) for count in counts] for phase in measured}
    steps = [sum(column) for column in zip(*times.values(), strict=True)]
    for phase, here in times.items():
        values = [ns * time / step for ns, time, step in zip(whole, here, steps, strict=True)]
        axes.bar(range(len(counts)), values, 0.6, bottom=floor, color=PHASES[phase], label=phase if max(values) > 1 else None)
        floor = [low + value for low, value in zip(floor, values, strict=True)]
    axes.set_xticks(range(len(counts)), counts)
    axes.set_xlabel("processes")
    axes.set_title("core time of a PP and step (ns), 100 000 a process", fontsize=9)


def costs(figures: Figures, file: Path) -> None:
    """The time of a step of the paper's system over processes; figures of bench/cost_model.py."""
    alone = figures.value("microseconds_per_step", system="paper", ranks=1) / 1e3
    counts = _ranks_of(figures, "microseconds_per_step", system="paper")
    with figure_of(file, 10, 3.2, columns=2) as (time, efficiency):
        times = [figures.value("microseconds_per_step", system="paper", ranks=count) / 1e3 for count in counts]
        time.plot(counts, times, "o-", color=BLUE, markersize=4, linewidth=1.2, label="predicted")
        time.plot(counts, [alone / count for count in counts], "--", color=GREY, linewidth=1, label="without ghosts and messages")
        time.set_yscale("log")
        time.set_title("the paper's 5.6 million PPs: a step (ms)", fontsize=9)
        shares = [figures.value("efficiency", system="paper", ranks=count) for count in counts]
        efficiency.plot(counts, shares, "o-", color=BLUE, markersize=4, linewidth=1.2)
        efficiency.set_ylim(0, 1.1)
        efficiency.set_title("efficiency against one process", fontsize=9)
        for axes in (time, efficiency):
            _log2(axes, counts)


PARTS = {"lay_out": ("blocks laid out", "#a9c4dd"), "distances": ("distances", "#3f79ad"), "pairs": ("pairs", BLUE)}
LIMITS = {"loads": "loads, nearest cache", "stores": "stores, nearest cache", "memory": "main memory",
          "roots": "roots", "multiplications": "multiplications", "additions": "additions", "both": "both at once",
          "integers": "integer additions", "full_lanes": "arithmetic on full lanes"}


def bounds(figures: Figures, file: Path) -> None:
    """What a pair takes in the pass, part by part, beside its bounds by the machine; figures of bench/roofline.py."""
    with figure_of(file, 9, 3.6, columns=2) as axes:
        axes[1].sharey(axes[0])
        for panel, (fluid, words) in zip(axes, FLUIDS.items(), strict=True):
            _bars_of_pair(panel, figures, fluid)
            panel.set_title(words, fontsize=10)
            panel.set_xlabel("ns per pair")
            panel.margins(x=0.12)
        axes[0].set_yticks(range(len(LIMITS) + 2), ["the pass, measured", "order and lists, once a stay", *LIMITS.values()])
        axes[0].invert_yaxis()
        axes[1].tick_params(labelleft=False)


def _bars_of_pair(axes, figures: Figures, fluid: str) -> None:
    """The pass, order and lists, and the limits, a row each, in ns per pair."""
    left = 0.0
    for part, (label, color) in PARTS.items():
        taken = figures.value("ns_per_pair", fluid=fluid, part=part)
        axes.barh(0, taken, 0.7, left=left, color=color, label=label)
        left += taken
    axes.text(left, 0, f" {figures.value('ns_per_pair', fluid=fluid, part='pass'):.3g}", va="center", fontsize=8)
    ordering = sum(figures.value("ns_per_pair", fluid=fluid, part=part) for part in ("sort", "search"))
    axes.barh(1, ordering, 0.7, color="#a9c4dd")
    axes.text(ordering, 1, f" {ordering:.3g}", va="center", fontsize=8)
    for row, limit in enumerate(LIMITS, start=2):
        value = figures.value("bound_ns_per_pair", fluid=fluid, limit=limit)
        axes.barh(row, value, 0.6, color=GREEN if limit == "full_lanes" else GREY)
        axes.text(value, row, f" {value:.2g}", va="center", fontsize=8)


def precisions(figures: Figures, file: Path) -> None:
    """Speed in both precisions; over the spacing, how far double precision is from the answer of a case and single from double;
    figures of bench/precision.py."""
    with figure_of(file, 10, 3.4, columns=2) as (speed, accuracy):
        _speeds_of_precisions(speed, figures)
        for case, marker in zip(figures.settings("case"), "os^D", strict=False):
            _differences(accuracy, figures, case, marker)
        accuracy.set_xscale("log")
        accuracy.set_yscale("log")
        accuracy.set_xlabel("spacing (in lengths of the case)")
        accuracy.set_title("difference over the answer", fontsize=9)


def _speeds_of_precisions(axes, figures: Figures) -> None:
    rows = [(name, precision) for name in FLUIDS for precision in ("double", "single")]
    for row, (name, precision) in enumerate(rows):
        rate = figures.value("particle_steps_per_s", fluid=name, precision=precision, ranks=1) / 1e6
        off = [part / 1e6 for part in figures.off("particle_steps_per_s", fluid=name, precision=precision, ranks=1)]
        axes.barh(row, rate, 0.7, color=BLUE if precision == "double" else GREEN, xerr=bars([off]), error_kw=ERROR)
        axes.text(rate + off[1], row, f" {rate:.3g}", va="center", fontsize=8)
    axes.set_yticks(range(len(rows)), [f"{FLUIDS[name]}, {precision}" for name, precision in rows], fontsize=8)
    axes.invert_yaxis()
    axes.margins(x=0.1)
    axes.set_xlabel("million particle-steps per second, one process")


def _differences(axes, figures: Figures, case: str, marker: str) -> None:
    """Over the spacings of the levels of a case."""
    levels = sorted(row.settings["level"] for row in figures.where("spacing", case=case))
    spacings = [figures.value("spacing", case=case, level=level) for level in levels]
    kinds = {"double_off_the_answer": (BLUE, "double, off the answer"), "single_off_double": (GREEN, "single, off double")}
    for name, (color, label) in kinds.items():
        values = [figures.value(name, case=case, level=level) for level in levels]
        axes.plot(spacings, values, marker + "-", color=color, markersize=4, linewidth=1.1, label=f"{case}: {label}")


# By the name of the benchmark.
CHARTS: dict[str, Callable[[Figures, Path], None]] = {
    "speed": speeds, "scaling": scalings, "cost_model": costs, "roofline": bounds, "precision": precisions, "solids": costs_of_solids,
}
