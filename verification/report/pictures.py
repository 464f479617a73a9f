"""Fields in the plane, drawn with pyvista without a display."""

import os
from pathlib import Path

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # asks for no X server

import numpy as np  # noqa: E402
import pyvista as pv  # noqa: E402

from verification.protocol.run import Run  # noqa: E402

PIXELS = 1500  # of the longer side
SCALE_PIXELS = 140  # at least, for the scale below the field


def _flat(run: Run, which: int) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray], np.ndarray, int, int]:
    """(PPs, balls, box, axis across, axis up) of the picture; in space only those near the middle plane of the third axis."""
    fluid, solids = run.fluid(which), run.solids(which) if run.snapshots("solids") else {}
    box = np.array(run.scene["box"]["size"], dtype=float)
    across, up = (1, 0) if box[1] > box[0] else (0, 1)
    if len(box) == 3:
        depth = fluid["points"][:, 2] - 0.5 * box[2]
        near = np.abs(depth) < 0.75 * run.scene["fluid"]["spacing"]
        fluid = {name: values[near] for name, values in fluid.items()}
        if solids:  # a ball shows as the disc in which the plane cuts it
            cut = solids["radius"] ** 2 - (solids["points"][:, 2] - 0.5 * box[2]) ** 2
            solids = {name: values[cut > 0] for name, values in solids.items()}
            solids["radius"] = np.sqrt(cut[cut > 0])
    return fluid, solids, box, across, up


def velocity_field(run: Run, file: Path, which: int = -1) -> None:
    """Speed of the PPs as coloured points, relative to their mean where free solids move with them, the solids as grey discs.

    The longer side of the box lies across the picture. Of a scene in space it shows the middle plane.
    """
    fluid, solids, box, across, up = _flat(run, which)
    width, height = box[across], box[up]
    pixels = PIXELS if width > 1.5 * height else PIXELS // 2

    def flat(points: np.ndarray) -> np.ndarray:
        return np.column_stack([points[:, across], points[:, up], np.zeros(len(points))])

    free = any(body.get("motion", "free") == "free" and body["shape"] != "wall" for body in run.scene.get("body", []))
    frame = fluid["velocity"].mean(axis=0) if free else 0.0
    speed = np.linalg.norm(fluid["velocity"] - frame, axis=1)
    unit = run.series.units["fluid_velocity_x"]
    title = ("speed relative to the mean of the fluid" if free else "speed") + (f" ({unit})" if unit else "") + "\n"

    field = pixels * height / width  # high, in pixels
    size = (pixels, round(field + max(0.19 * field, SCALE_PIXELS)))
    bar = 1 - field / size[1]  # of the picture's height, for the scale
    plotter = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.set_background("white")
    cloud = pv.PolyData(flat(fluid["points"]))
    cloud[title] = speed
    spacing = run.scene["fluid"]["spacing"]
    plotter.add_mesh(
        cloud, scalars=title, cmap="viridis", clim=[0.0, float(np.quantile(speed, 0.998)) or 1.0], style="points",
        point_size=max(2.0, 1.7 * pixels * spacing / width), lighting=False,
        scalar_bar_args={"position_x": 0.2, "position_y": 0.01, "width": 0.6, "height": 0.8 * bar, "color": "black",
                         "title_font_size": 20, "label_font_size": 18, "n_labels": 3, "fmt": "%.2g"},
    )
    for centre, radius in zip(flat(solids["points"]), solids["radius"], strict=True) if solids else ():
        for i in (-1, 0, 1):  # periodic images that reach into the box
            for j in (-1, 0, 1):
                x, y = centre[0] + i * width, centre[1] + j * height
                if -radius < x < width + radius and -radius < y < height + radius:
                    disc = pv.Disc(center=(x, y, 1e-3 * width), inner=0.0, outer=radius, c_res=48)
                    plotter.add_mesh(disc, color="#3a3f47", lighting=False)
    plotter.enable_parallel_projection()
    shown = height / (1 - bar)
    plotter.camera.focal_point = (0.5 * width, height - 0.5 * shown, 0.0)
    plotter.camera.position = (0.5 * width, height - 0.5 * shown, width)
    plotter.camera.up = (0.0, 1.0, 0.0)
    plotter.camera.parallel_scale = 0.5 * shown
    plotter.camera.clipping_range = (0.5 * width, 2.0 * width)
    plotter.screenshot(file)
    plotter.close()
