"""The script for boards prints its line, and refuses in one line what it cannot use."""

import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).with_name("measure.py")
ADDRESS = 0x20000010


def elf(name):
    """A file with one symbol."""
    strings = b"\0" + name + b"\0"
    symbol = struct.pack("<IIIBBH", 1, ADDRESS, 4, 1, 0, 1)
    table = 52 + len(strings) + len(symbol)
    header = b"\x7fELF\x01\x01\x01" + bytes(9)
    header += struct.pack("<HHIIIIIHHHHHH", 2, 40, 1, 0, 0, table, 0, 52, 32, 0, 40, 3, 0)
    sections = bytes(40)
    sections += struct.pack("<10I", 0, 3, 0, 0, 52, len(strings), 0, 0, 1, 0)
    sections += struct.pack("<10I", 0, 2, 0, 0, 52 + len(strings), 16, 1, 0, 4, 16)
    return header + strings + symbol + sections


class MeasureTest(unittest.TestCase):
    def run_script(self, probe, name=b"SCANBEAM_FRAMES", seconds="0.05"):
        """Runs it with a program in probe-rs's place."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "elf").write_bytes(elf(name))
            if probe:
                (folder / "probe-rs").write_text(f"#!/bin/sh\n{probe}\n")
                (folder / "probe-rs").chmod(0o755)
            words = [sys.executable, SCRIPT, "RP2040", folder / "elf", seconds]
            path = f"{folder}:/usr/bin:/bin"
            environment = {**os.environ, "PATH": path, "COUNT": str(folder / "count")}
            return subprocess.run(words, capture_output=True, text=True, env=environment)

    def test_a_line_is_printed(self):
        # The counter wraps around between the two reads.
        probe = f"""[ "$*" = "read --chip RP2040 b32 {ADDRESS:#x} 1" ] || exit 1
            [ -f "$COUNT" ] && echo 00000003 || echo fffffffe
            touch "$COUNT" """
        done = self.run_script(probe)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"^RP2040: 5 frames in \d+\.\d\d s, \d+\.\d\d a second, \S+\n$")

    def test_what_cannot_be_used_is_refused_in_one_line(self):
        for probe, name, seconds, reason in (
            (None, b"SCANBEAM_FRAMES", "1", "cannot be run"),
            ("echo no probe >&2; exit 1", b"SCANBEAM_FRAMES", "1", "no probe"),
            ("echo nothing", b"SCANBEAM_FRAMES", "1", "said no word"),
            ("echo 0", b"OTHER", "1", "has no SCANBEAM_FRAMES"),
            ("echo 0", b"SCANBEAM_FRAMES", "soon", "soon"),
        ):
            with self.subTest(reason=reason):
                done = self.run_script(probe, name, seconds)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertEqual(done.stderr.count("\n"), 1)
                self.assertIn(reason, done.stderr)


if __name__ == "__main__":
    unittest.main()
