"""The program vkpm as a process: where it is, its arguments, what it logs."""

import json
import os
import shutil
import signal
import subprocess
from pathlib import Path

SOURCE_TREE = Path(__file__).resolve().parents[3] / "build/release/vkpm"


def find(path):
    """The program: the path that is given, or vkpm in PATH, or that of the source tree around this add-on; or None."""
    if path:
        found = Path(path).expanduser()
        return str(found) if found.is_file() and os.access(found, os.X_OK) else None
    if shutil.which("vkpm"):
        return shutil.which("vkpm")
    return str(SOURCE_TREE) if SOURCE_TREE.is_file() else None


class Render:
    """A render that runs. Its files are in the scene's folder: picture, log, and what the program says."""

    def __init__(self, program, scene, arguments):
        self.picture, self.log = scene.with_suffix(".exr"), scene.with_suffix(".jsonl")
        self.said = scene.with_suffix(".txt")
        command = [
            program,
            "--scene",
            str(scene),
            "-o",
            str(self.picture),
            "--log",
            str(self.log),
            "--quiet",
            *arguments,
        ]
        self.read = 0
        for old in (self.picture, self.log):
            old.unlink(missing_ok=True)
        with open(self.said, "wb") as said:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said, stderr=said)

    def events(self):
        """The log's new lines, each an object; a line that is not whole yet waits."""
        try:
            with open(self.log, "rb") as file:
                file.seek(self.read)
                text = file.read()
        except FileNotFoundError:
            return []
        whole = text[: text.rfind(b"\n") + 1]
        self.read += len(whole)
        return [json.loads(line) for line in whole.splitlines()]

    def wait(self, seconds):
        """Whether it has ended within these seconds."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        return True

    def interrupt(self):
        """Ends it after the current pass; what it has is saved."""
        self.process.send_signal(signal.SIGINT)

    def message(self):
        """What it said, such as why it ended."""
        return self.said.read_text(errors="replace").strip()
