# SPDX-License-Identifier: Apache-2.0
"""What a program takes: seconds and memory. And what it was measured on."""

import dataclasses
import datetime
import os
import pathlib
import subprocess
import tempfile
import time


@dataclasses.dataclass
class Run:
    wall: float  # seconds
    processor: float  # seconds of all threads, and of the programs that it started
    memory: int  # bytes: the most that it, or a program that it started, had in memory
    said: str  # on stdout


class Failed(Exception):
    pass


def run(command):
    command = [str(word) for word in command]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as errors:
        start = time.perf_counter()
        child = subprocess.Popen(command, stdout=out, stderr=errors)
        _, status, used = os.wait4(child.pid, 0)
        wall = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), errors.seek(0)
        said, complaint = out.read(), errors.read()
    if child.returncode:
        raise Failed(f"{' '.join(command)}: exit code {child.returncode}\n{complaint[-2000:]}")
    return Run(wall, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024, said)


def circumstances(threads):
    """The day, the processor, and how busy it is: a line for the head of a table."""
    names = [
        line.split(":")[1].strip()
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        if line.startswith("model name")
    ]
    return (
        f"{datetime.date.today():%d %B %Y}, {names[0] if names else 'unknown processor'}, "
        f"{threads} threads, load {os.getloadavg()[0]:.1f} at the start"
    )
