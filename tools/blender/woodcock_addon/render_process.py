# SPDX-License-Identifier: Apache-2.0
"""The `woodcock` program at work, and what it tells. Needs no Blender."""
import json
import queue
import subprocess
import threading


class RenderProcess:
    """Renders a scene file to an image in the background."""

    def __init__(self, program, scene, image):
        self.process = subprocess.Popen(
            [program, "render", scene, "-o", image, "--progress", "json"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.lines = queue.Queue()
        self.fraction = 0.0
        self.messages = []  # of warnings and errors
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stderr:
            self.lines.put(line)

    def poll(self):
        """Takes in what has been told; the exit code once it has ended, else None."""
        code = self.process.poll()
        if code is not None:
            self.reader.join()
        while not self.lines.empty():
            self._understand(self.lines.get())
        return code

    def _understand(self, line):
        try:
            event = json.loads(line)
        except ValueError:
            self.messages.append(line.strip())
            return
        if "fraction" in event:
            self.fraction = event["fraction"]
        if event.get("event") == "log" and event.get("level") in ("warning", "error", "critical"):
            self.messages.append(event.get("message", ""))

    def cancel(self):
        """Lets it write what it has, and end."""
        if self.process.poll() is None:
            self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
