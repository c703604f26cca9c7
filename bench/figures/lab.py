# SPDX-License-Identifier: Apache-2.0
"""Where figures are measured: the programs of a build, and data that are made once and kept."""
import dataclasses
import json
import os
import pathlib
import shlex
import subprocess
import tempfile
import time

MIB = 1 << 20
SOURCES = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass
class Figure:
    """One line of the table."""
    what: str
    asked: str
    reached: str
    error: str  # at which it was reached; empty where there is none to state
    met: bool
    command: str


@dataclasses.dataclass
class Run:
    output: str
    seconds: float
    peak_bytes: int  # largest resident set of the process, not of those it started


class Lab:
    def __init__(self, build, work):
        self.build = pathlib.Path(build).resolve()
        self.work = pathlib.Path(work).resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.eyrie = self.build / "bin/eyrie"
        self.commands = []  # as a reader would type them, since the figure began

    def tool(self, name):
        return self.build / "bench" / name

    def shown(self, command):
        """`command` without the folders of this machine."""
        text = shlex.join(str(part) for part in command)
        for folder, name in ((self.eyrie, "eyrie"), (self.work, "."), (self.build, "build/release"),
                             (pathlib.Path.cwd(), ".")):
            text = text.replace(str(folder), name)
        return text.replace("././", "./").replace(" ./", " ")

    def run(self, *command, environment=None, is_shown=True):
        if is_shown:
            self.commands.append(self.shown(command))
        with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
            begin = time.perf_counter()
            process = subprocess.Popen([str(part) for part in command], cwd=self.work,
                                       stdout=output, stderr=errors,
                                       env={**os.environ, **(environment or {})})
            _, status, usage = os.wait4(process.pid, 0)
            seconds = time.perf_counter() - begin
            process.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0)
            errors.seek(0)
            if process.returncode != 0:
                raise RuntimeError(f"{self.shown(command)} ended with {process.returncode}: "
                                   f"{errors.read().strip()[-2000:]}")
            return Run(output.read(), seconds, usage.ru_maxrss * 1024)

    def bench(self, scene, *options):
        """`summary.json` of `eyrie bench`, of its only run."""
        self.run(self.eyrie, "bench", scene, *options, "--quiet", "-o", "report")
        summary = json.loads((self.work / "report/summary.json").read_text())
        return summary["runs"][0]

    def info(self, path):
        return json.loads(self.run(self.eyrie, "info", path, "--json", is_shown=False).output)

    # --- Data ------------------------------------------------------------------------------------

    def made(self, name, *command):
        """The file `name`, by `command` where it is not there yet."""
        path = self.work / name
        if not path.exists():
            self.run(*command, is_shown=False)
        return path

    def elevations(self, side):
        name = f"t{side}.tif"
        return self.made(name, self.eyrie, "synth", "terrain", "--size", side, "--seed", 1, "-o",
                         name, "--quiet")

    def terrain(self, side):
        name = f"t{side}.eyt"
        return self.made(name, self.eyrie, "import", "terrain", self.elevations(side), "-o", name,
                         "--quiet")

    def ball(self, triangles):
        """As steep at every size, down to single triangles: nothing of it simplifies easily."""
        name = f"ball{triangles}.ply"
        return self.made(name, self.eyrie, "synth", "mesh", "--size", triangles, "--roughness", 0.48,
                         "--seed", 1, "-o", name, "--quiet")

    def smooth_ball(self, triangles):
        """As scans simplify."""
        name = f"smooth{triangles}.ply"
        return self.made(name, self.eyrie, "synth", "mesh", "--size", triangles, "--seed", 1, "-o",
                         name, "--quiet")

    def scan(self, subdivisions):
        """The demo's scan with each triangle cut into 4^subdivisions and noise on it."""
        name = f"scan{subdivisions}.ply"
        return self.made(name, self.eyrie, "synth", "mesh", "--from",
                         SOURCES / "demo/rocker_arm.ply", "--subdivide",
                         subdivisions, "--displace", 0.0001, "-o", name, "--quiet")

    def mesh(self, source):
        name = source.stem + ".eym"
        return self.made(name, self.eyrie, "import", "mesh", source, "-o", name, "--quiet")
