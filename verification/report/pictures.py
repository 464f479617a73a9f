"""The velocity of the fluid in the plane: x to the right, y upward, solids and walls grey."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.patches import Circle, Rectangle
from matplotlib.ticker import FuncFormatter, MaxNLocator

from verification.protocol.run import Run, read_points, read_time
from verification.protocol.scene import in_si
from verification.report.canvas import DARK, figure_of, number
from verification.report.fields import Window, near_middle, on_grid
from verification.report.shapes import Balls, Strip, balls_of_run, box_of, images, strips_of, window_of

SOLID, WALL = "#4b515a", "#a3a8b0"
LONGEST = np.array([6.4, 5.6])  # inches across and up that a field takes at most
SMALL = np.array([2.0, 2.0])  # and a fluid at rest
WIDE = 1.8  # over the height: a scale of colours beside would be too short
ARROWS = 18  # along the longer side
ARROW_SIGNS = "\u2192\u2191\u2190\u2193"  # to the right, up, to the left, down


@dataclass(frozen=True)
class Flow:
    """What a picture shows."""

    window: Window
    velocity: np.ndarray  # (2 or 3, rows, columns), less that of the frame
    fastest: float  # of nearly all particles of the fluid
    balls: Balls
    strips: list[Strip]
    relative: bool  # to the mean of the fluid

    @property
    def speed(self) -> np.ndarray:
        return np.linalg.norm(self.velocity, axis=0)

    def is_fluid(self, x: np.ndarray, y: np.ndarray, margin: float) -> np.ndarray:
        """Farther than `margin` from solids and walls."""
        found = self.balls.distance(x, y) > margin
        for strip in self.strips:
            for shift in images(self.balls.box):
                low, high = strip.low + shift - margin, strip.high + shift + margin
                found &= ~((x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1]))
        return found


def _frame(scene: dict, velocity: np.ndarray) -> np.ndarray:
    """The mean of the fluid (D,), where nothing that is held gives a frame and the fluid goes anywhere as a whole; else zeros."""
    mean = velocity.mean(axis=0)
    held = any(body.get("motion", "free") != "free" or body["shape"] == "wall" for body in scene.get("body", []))
    stream = np.linalg.norm(mean) > 0.01 * np.linalg.norm(velocity, axis=1).max(initial=0.0)
    return mean if stream and not held else np.zeros_like(mean)


def flow_of(run: Run, which: int = -1) -> Flow:
    """Of a snapshot. FPs have the velocity of their solid, which the fluid has at its surface."""
    scene, data = run.scene, read_points(run.snapshots()[which])
    box, spacing = box_of(scene), in_si(scene["fluid"]["spacing"])
    points, velocity = (data[name][:, : len(box)].astype(float) for name in ("points", "velocity"))
    fluid = data["kind"] == 0
    frame = _frame(scene, velocity[fluid])
    weights = near_middle(points[:, 2] - 0.5 * box[2], spacing) if len(box) == 3 else np.ones(len(points))
    window = Window(window_of(scene), box[:2])
    field = on_grid(points[:, :2], velocity - frame, window, spacing, weights)
    speed = np.linalg.norm(velocity[fluid & (weights > 0)] - frame, axis=1)
    return Flow(window, field, float(np.quantile(speed, 0.998)), balls_of_run(run, which), strips_of(scene), bool(frame.any()))


def _draw_solids(axes, flow: Flow) -> None:
    """With the periodic images that reach into the window."""
    left, right, bottom, top = flow.window.extent
    for shift in images(flow.balls.box):
        for centre, radius in flow.balls.discs():
            x, y = centre + shift
            if left - radius < x < right + radius and bottom - radius < y < top + radius:
                axes.add_patch(Circle((x, y), radius, facecolor=SOLID, edgecolor="black", linewidth=0.8, zorder=3))
        for strip in flow.strips:
            axes.add_patch(Rectangle(strip.low + shift, *(strip.high - strip.low), facecolor=WALL, edgecolor=WALL, zorder=3))


def _seen(strip: Strip, flow: Flow) -> tuple[np.ndarray, np.ndarray]:
    """(centre, sides) of the largest part of the wall and its images that lies in the window."""
    begin, end = flow.window.corner, flow.window.corner + flow.window.sides
    through = strip.high - strip.low > (1 - 1e-9) * flow.window.sides  # from one end of the period to the other
    parts = [(np.where(through, begin, np.maximum(strip.low + shift, begin)),
              np.where(through, end, np.minimum(strip.high + shift, end))) for shift in images(flow.balls.box)]
    low, high = max(parts, key=lambda part: float(np.prod(np.maximum(part[1] - part[0], 0.0))))
    return 0.5 * (low + high), high - low


def _name_moving_walls(axes, flow: Flow, unit: str) -> None:
    for strip in flow.strips:
        size = float(np.linalg.norm(strip.velocity))
        if size > 0:
            (x, y), (width, height) = _seen(strip, flow)
            arrow = ARROW_SIGNS[round(float(np.arctan2(strip.velocity[1], strip.velocity[0]) / (np.pi / 2))) % 4]
            axes.text(x, y, " ".join(filter(None, ("wall moves at", f"{size:.3g}", unit, arrow))), ha="center", va="center",
                      fontsize=8, rotation=0 if width > height else 90, zorder=4)


def _draw_arrows(axes, flow: Flow) -> None:
    """The direction of the flow where it moves at all, their length the speed."""
    _, rows, columns = flow.velocity.shape
    step = max(1, round(max(rows, columns) / ARROWS))
    chosen = np.s_[min(step, rows) // 2 :: step, min(step, columns) // 2 :: step]
    x, y = (places[chosen] for places in flow.window.nodes((rows, columns)))
    u, v = flow.velocity[0][chosen], flow.velocity[1][chosen]
    spacing = float(flow.window.sides.max()) / ARROWS
    shown = flow.is_fluid(x, y, 0.3 * spacing) & (np.hypot(u, v) > 0.03 * flow.fastest)
    axes.quiver(x[shown], y[shown], u[shown], v[shown], angles="xy", scale_units="xy", scale=1.1 * flow.fastest / spacing,
                pivot="mid", color="white", alpha=0.75, width=0.0035, headwidth=3.5, headlength=4, zorder=2)


def _draw_scale(axes, drawn, label: str, width: float, height: float) -> None:
    """Of colours, as long as the field (inches): beside it, or below a field that is much wider than high."""
    beside = width < WIDE * height
    place = (1 + 0.12 / width, 0.0, 0.16 / width, 1.0) if beside else (0.0, -0.72 / height, 1.0, 0.16 / height)
    bar = axes.figure.colorbar(drawn, cax=axes.inset_axes(place, label="<colorbar>"), label=label,
                               format=FuncFormatter(lambda value, _: number(value)),
                               orientation="vertical" if beside else "horizontal")
    bar.locator = MaxNLocator(5, steps=[1, 2, 2.5, 5, 10])
    bar.update_ticks()


def _title(run: Run, flow: Flow, which: int) -> str:
    box, unit = flow.balls.box, run.series.units["time"]
    plane = f"plane z = {0.5 * box[2]:.3g}, " if len(box) == 3 else ""
    time = float(f"{read_time(run.snapshots()[which]):.3g}")
    return f"{plane}t = {number(time)} {unit}".rstrip()


def _draw_flow(axes, flow: Flow, unit: str, width: float, height: float) -> None:
    drawn = axes.imshow(flow.speed, origin="lower", extent=flow.window.extent, cmap="viridis", vmin=0.0, vmax=flow.fastest,
                        interpolation="bilinear")
    words = "speed, relative to the mean of the fluid" if flow.relative else "speed"
    _draw_scale(axes, drawn, words + (f" ({unit})" if unit else ""), width, height)
    _draw_arrows(axes, flow)


def velocity_field(run: Run, file: Path, which: int = -1) -> None:
    """Speed in colour and direction as arrows, relative to the mean of the fluid where it goes anywhere as a whole. Of a scene in
    space it shows the middle plane. Of a fluid at rest it says so."""
    flow = flow_of(run, which)
    moves = flow.fastest > 0
    unit = run.series.units["fluid_velocity_x"]
    length = " (m)" if unit == "m/s" else ""
    width, height = flow.window.sides / max(flow.window.sides / (LONGEST if moves else SMALL))
    room = (1.5, 0.8) if width < WIDE * height else (0.8, 1.45)
    with figure_of(file, width + room[0], height + room[1], cut=True) as axes:
        axes.grid(visible=False)
        if moves:
            _draw_flow(axes, flow, unit, width, height)
        else:
            axes.text(0.5, 0.5, "The fluid is at rest:\nthe speed is 0\neverywhere.", transform=axes.transAxes, ha="center",
                      va="center")
        _draw_solids(axes, flow)
        _name_moving_walls(axes, flow, unit)
        axes.set(xlim=flow.window.extent[:2], ylim=flow.window.extent[2:], aspect="equal", xlabel="x" + length,
                 ylabel="y" + length)
        axes.set_title(_title(run, flow, which), fontsize=10, color=DARK)
