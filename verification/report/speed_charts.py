"""Charts of what the benchmarks of bench/ keep in reports/published."""

from pathlib import Path

from verification.report.charts import BLUE, DARK, GREEN, GREY, RED, figure_of
from verification.report.solid_charts import costs_of_solids

FLUIDS = {"2d_39": "plane, 39 neighbours", "3d_77": "space, 77 neighbours"}
PALE = "#6f9cc4"
PHASES = {"pairs": BLUE, "lists": PALE, "sort": GREY, "integrate": GREEN, "solids": DARK, "exchange": RED}


CODES = {"": ("MaPPM", BLUE), "without_transport_": ("MaPPM, no transport velocity", PALE), "lammps_": ("LAMMPS, SPH", DARK),
         "liggghts_": ("LIGGGHTS, SPH", GREY)}


def speeds(figures: dict[str, float], file: Path) -> None:
    """Particle-steps a second, and flow time a core-second at the largest useful step of each code, on one process and on two;
    figures of bench/speed.py."""
    panels = {"particle_steps_per_s": "million particle-steps per second",
              "flow_time_per_core_s": "million particles times h/c, per core-second"}
    panels = {name: words for name, words in panels.items() if f"figure fluid_2d_39.{name}_1" in figures}  # older tables know one
    with figure_of(file, 5.5 * len(panels), 3.6, columns=len(panels)) as made:
        for panel, (name, words) in zip([made] if len(panels) == 1 else made, panels.items(), strict=True):
            _bars_of_codes(panel, figures, name)
            panel.set_xlabel(words)


def _bars_of_codes(axes, figures: dict[str, float], name: str) -> None:
    places = {(fluid, ranks): 2 * row + 0.9 * k for row, fluid in enumerate(FLUIDS) for k, ranks in enumerate((1, 2))}
    for side, (code, (words, color)) in zip((-0.3, -0.1, 0.1, 0.3), CODES.items(), strict=True):
        rates = {place: figures.get(f"figure fluid_{fluid}.{code}{name}_{ranks}") for (fluid, ranks), place in places.items()}
        rates = {place: rate / 1e6 for place, rate in rates.items() if rate is not None}
        axes.barh([place + side for place in rates], list(rates.values()), 0.19, color=color, label=words if rates else None)
        for place, rate in rates.items():
            axes.text(rate, place + side, f" {rate:.2g}", va="center", fontsize=7)
    axes.set_yticks(list(places.values()), [f"{FLUIDS[fluid]}, {'one process' if ranks == 1 else 'two'}" for fluid, ranks in places],
                    fontsize=8)
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.legend(frameon=False, fontsize=7, loc="lower right")


def _over_processes(figures: dict[str, float], prefix: str, name: str) -> dict[int, float]:
    """{processes: value} of the figures `prefix.PROCESSES.name`."""
    parts = {key.split(" ")[1]: value for key, value in figures.items()}
    return {int(key.split(".")[-2]): value for key, value in parts.items()
            if key.startswith(prefix + ".") and key.endswith("." + name) and key.split(".")[-2].isdigit()}


def _log2(axes, counts: list[int]) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.set_xlabel("processes")


def scalings(figures: dict[str, float], file: Path) -> None:
    """Efficiency over processes, and the core time of a PP by phase; figures of bench/scaling.py."""
    with figure_of(file, 10, 3.4, columns=2) as (efficiency, phases):
        sets = {"strong_2d": ("a million PPs, plane", BLUE, "o-"), "strong_3d": ("half a million, space", GREEN, "s-"),
                "weak_2d": ("100 000 a process, plane", DARK, "^--")}
        for prefix, (label, color, style) in sets.items():
            found = {1: 1.0} | _over_processes(figures, prefix, "efficiency")
            efficiency.plot(list(found), list(found.values()), style, color=color, markersize=4, linewidth=1.2, label=label)
        counts = list(found)
        _log2(efficiency, counts)
        efficiency.set_ylim(0, 1.1)
        efficiency.set_title("efficiency against one process", fontsize=9)
        efficiency.legend(frameon=False, fontsize=7, loc="lower left")
        floor = [0.0] * len(counts)
        rates = _over_processes(figures, "weak_2d", "particle_steps_per_s")
        measured = {phase: _over_processes(figures, "weak_2d", f"microseconds_{phase}") for phase in PHASES}
        measured = {phase: seconds for phase, seconds in measured.items() if seconds}  # older tables know fewer phases
        step = {count: sum(seconds[count] for seconds in measured.values()) for count in counts}
        for phase, seconds in measured.items():
            values = [1e9 / rates[count] * count * seconds[count] / step[count] for count in counts]
            phases.bar(range(len(counts)), values, 0.6, bottom=floor, color=PHASES[phase], label=phase if max(values) > 1 else None)
            floor = [low + value for low, value in zip(floor, values, strict=True)]
        phases.set_xticks(range(len(counts)), counts)
        phases.set_xlabel("processes")
        phases.set_title("core time of a PP and step (ns), 100 000 a process", fontsize=9)
        phases.legend(frameon=False, fontsize=7, loc="upper left")


def costs(figures: dict[str, float], file: Path) -> None:
    """The parts of a step of the paper's system over processes, and their sum; figures of bench/cost_model.py."""
    with figure_of(file, 10, 3.2, columns=2) as (time, efficiency):
        seconds = _over_processes(figures, "paper", "microseconds_per_step")
        share = _over_processes(figures, "paper", "efficiency")
        time.plot(list(seconds), [value / 1e3 for value in seconds.values()], "o-", color=BLUE, markersize=4, linewidth=1.2,
                  label="predicted")
        time.plot(list(seconds), [next(iter(seconds.values())) / 1e3 / count for count in seconds], "--", color=GREY, linewidth=1,
                  label="without ghosts and messages")
        time.set_yscale("log")
        time.set_title("the paper's 5.6 million PPs: a step (ms)", fontsize=9)
        time.legend(frameon=False, fontsize=8)
        efficiency.plot(list(share), list(share.values()), "o-", color=BLUE, markersize=4, linewidth=1.2)
        efficiency.set_ylim(0, 1.1)
        efficiency.set_title("efficiency against one process", fontsize=9)
        for axes in (time, efficiency):
            _log2(axes, list(seconds))


def bounds(figures: dict[str, float], file: Path) -> None:
    """What a pair takes in the pass, part by part, beside its bounds by the machine; figures of bench/roofline.py."""
    parts = {"lay_out": ("blocks laid out", "#a9c4dd"), "distances": ("distances", "#3f79ad"), "pairs": ("pairs", BLUE)}
    limits = {"loads": "loads, nearest cache", "stores": "stores, nearest cache", "memory": "main memory",
              "roots": "roots", "multiplications": "multiplications", "additions": "additions", "both": "both at once",
              "integers": "integer additions", "full_lanes": "arithmetic on full lanes"}
    with figure_of(file, 9, 3.6, columns=2) as axes:
        axes[1].sharey(axes[0])
        for panel, (name, words) in zip(axes, FLUIDS.items(), strict=True):
            left = 0.0
            for part, (label, color) in parts.items():
                taken = figures[f"figure fluid_{name}.ns_per_pair_{part}"]
                panel.barh(0, taken, 0.7, left=left, color=color, label=label)
                left += taken
            whole = figures[f"figure fluid_{name}.ns_per_pair_pass"]
            panel.text(left, 0, f" {whole:.3g}", va="center", fontsize=8)
            ordering = sum(figures[f"figure fluid_{name}.ns_per_pair_{part}"] for part in ("sort", "search"))
            panel.barh(1, ordering, 0.7, color="#a9c4dd")
            panel.text(ordering, 1, f" {ordering:.3g}", va="center", fontsize=8)
            for row, limit in enumerate(limits, start=2):
                value = figures[f"figure fluid_{name}.bound_ns_per_pair_{limit}"]
                panel.barh(row, value, 0.6, color=GREEN if limit == "full_lanes" else GREY)
                panel.text(value, row, f" {value:.2g}", va="center", fontsize=8)
            panel.set_title(words, fontsize=10)
            panel.set_xlabel("ns per pair")
            panel.margins(x=0.12)
        axes[0].set_yticks(range(len(limits) + 2), ["the pass, measured", "order and lists, once a stay", *limits.values()])
        axes[0].invert_yaxis()
        axes[1].tick_params(labelleft=False)
        axes[1].legend(frameon=False, fontsize=8, loc="lower right")


def precisions(figures: dict[str, float], file: Path) -> None:
    """Speed in both precisions; over the spacing, how far double precision is from the answer of a case and single from double;
    figures of bench/precision.py."""
    with figure_of(file, 10, 3.4, columns=2) as (speed, accuracy):
        rows = [(name, precision) for name in FLUIDS for precision in ("double", "single")]
        for row, (name, precision) in enumerate(rows):
            rate = figures[f"figure fluid_{name}.particle_steps_per_s_{precision}"] / 1e6
            speed.barh(row, rate, 0.7, color=BLUE if precision == "double" else GREEN)
            speed.text(rate, row, f" {rate:.3g}", va="center", fontsize=8)
        speed.set_yticks(range(len(rows)), [f"{FLUIDS[name]}, {precision}" for name, precision in rows], fontsize=8)
        speed.invert_yaxis()
        speed.margins(x=0.1)
        speed.set_xlabel("million particle-steps per second, one process")
        cases = dict.fromkeys(key.split()[1].split(".")[0] for key in figures if ".level_" in key)
        for case, marker in zip(cases, "os^D", strict=False):
            levels = sorted({key.split(".")[1] for key in figures if key.split()[1].startswith(case + ".level_")})
            spacings = [figures[f"figure {case}.{level}.spacing"] for level in levels]
            for words, color, label in (("double_off_the_answer", BLUE, "double, off the answer"), ("single_off_double", GREEN, "single, off double")):
                values = [figures[f"ratio {case}.{level}.{words}"] for level in levels]
                accuracy.plot(spacings, values, marker + "-", color=color, markersize=4, linewidth=1.1, label=f"{case}: {label}")
        accuracy.set_xscale("log")
        accuracy.set_yscale("log")
        accuracy.set_xlabel("spacing (in lengths of the case)")
        accuracy.set_title("difference over the answer", fontsize=9)
        accuracy.legend(frameon=False, fontsize=6)


# By the name of the table in reports/published.
CHARTS = {"speed": speeds, "scaling": scalings, "cost_model": costs, "roofline": bounds, "precision": precisions, "solids": costs_of_solids}
