"""The codes that bench.speed compares, each run on the same periodic fluid: MaPPM, LIGGGHTS' SPH and LAMMPS'."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

from bench.meter import Broken, Speed
from reference.lammps import program as lammps
from reference.lammps import sph as lammps_sph
from reference.liggghts import program as liggghts
from reference.liggghts import sph as liggghts_sph
from reference.periodic_fluid import ABC, VORTICES, WAVE, Fluid, energies_of, loop_seconds
from reference.sph_peer import Peer, energies_script, timed_script
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run

SCENE = ROOT / "cases" / "sph_peer" / "case.toml"
SKINS = (0.3, 0.6, 1.0)  # of the peers' lists of neighbours, in spacings; the quickest is taken
FLOWS = {
    WAVE: 'wave={amplitude=1.0, direction="x", gradient="y"}',
    VORTICES: "vortices={amplitude=1.0}",
    ABC: f"abc={{amplitude={6**-0.5!r}}}",
}


class Code(Protocol):
    @property
    def name(self) -> str: ...

    def energies(self, fluid: Fluid, every: int, folder: Path) -> list[tuple[int, float]]:
        """(step, kinetic energy) every so many steps, in any unit. Throws SolverError or Failed."""

    def speed(self, fluid: Fluid, ranks: int, folder: Path) -> Speed:
        """Throws SolverError, Failed or Broken."""


def own_speed(overrides: tuple[str, ...], steps: int, ranks: int, folder: Path) -> Speed:
    finished: Run = run(SCENE, folder / "mappm", Options(ranks=ranks, steps=steps, overrides=overrides))
    record = finished.record
    phases = {name: seconds for name, seconds in record["wall_seconds"].items() if name not in ("output", "steps")}
    return Speed(record["particle_steps_per_second"], record["digest"], phases)


def fluid_table(fluid: Fluid) -> str:
    """As an override of sph_peer."""
    entries = ["density=1.0", f"viscosity={fluid.dynamic_viscosity!r}", "spacing=1.0", f"rcut={fluid.reach!r}",
               f"sound_speed={fluid.sound_speed!r}", FLOWS[fluid.flow]]
    if fluid.disorder:
        entries.append(f"disorder={{amplitude={fluid.disorder!r}, seed=1}}")
    return f"fluid={{{', '.join(entries)}}}"


def overrides_of(fluid: Fluid, every: int = 1_000_000) -> tuple[str, ...]:
    """Overrides of sph_peer: the fluid, its step in seconds, and samples every so many steps."""
    return (
        f"box.size={[float(fluid.side)] * fluid.dimension}",
        fluid_table(fluid),
        f"run={{step={fluid.step * fluid.time_unit!r}, steps={fluid.steps}}}",
        f"output={{sample={every}, snapshot=1000000}}",
    )


@dataclass(frozen=True)
class Own:
    name: str
    more: tuple[str, ...] = ()  # overrides

    def energies(self, fluid: Fluid, every: int, folder: Path) -> list[tuple[int, float]]:
        series = run(SCENE, folder / "mappm", Options(overrides=overrides_of(fluid, every) + self.more)).series
        return [(int(step), float(energy)) for step, energy in zip(series["step"], series["fluid_energy"], strict=True)]

    def speed(self, fluid: Fluid, ranks: int, folder: Path) -> Speed:
        return own_speed(overrides_of(fluid) + self.more, fluid.steps, ranks, folder)


@dataclass(frozen=True, eq=False)
class Other:
    name: str
    peer: Peer
    skins: dict[Fluid, float] = field(default_factory=dict)  # chosen so far

    def energies(self, fluid: Fluid, every: int, folder: Path) -> list[tuple[int, float]]:
        return energies_of(self.peer.run_script(energies_script(self.peer, fluid, every), folder / self.name, 1).log)

    def speed(self, fluid: Fluid, ranks: int, folder: Path) -> Speed:
        if fluid not in self.skins:
            part = replace(fluid, steps=max(1, fluid.steps // 2))
            self.skins[fluid] = max(SKINS, key=lambda skin: self._rate(part, skin, 1, folder))
        return Speed(self._rate(fluid, self.skins[fluid], ranks, folder))

    def _rate(self, fluid: Fluid, skin: float, ranks: int, folder: Path) -> float:
        finished = self.peer.run_script(timed_script(self.peer, fluid, skin), folder / self.name, ranks)
        try:
            return fluid.particles * fluid.steps / loop_seconds(finished.log, fluid)
        except ValueError as error:
            raise Broken(f"{self.peer.code}: {error}") from None


MAPPM, WITHOUT_TRANSPORT = Own("mappm"), Own("without_transport", ("fluid.transport=false",))


def peers() -> tuple[list[Other], list[str]]:
    """Those that are installed, and what to do for those that are not, a line each."""
    known = ((Other("liggghts", liggghts_sph.PEER), liggghts), (Other("lammps", lammps_sph.PEER), lammps))
    return ([peer for peer, program in known if program.installed()],
            [program.MISSING for _, program in known if not program.installed()])
