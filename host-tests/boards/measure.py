#!/usr/bin/env python3
"""Prints a line of figures of a board that turns the teapot, to be sent in.

    measure.py CHIP ELF [SECONDS]

Flash the example first, and let it run. The program probe-rs reads the counter of frames through a
debug probe, twice; CHIP is its name of the chip, such as RP2040, RP235x or STM32F411RETx.
"""

import subprocess
import sys
import time

from elf import Elf

COUNTER = "SCANBEAM_FRAMES"


def read_word(chip, address):
    """A word of the board's memory."""
    words = ["probe-rs", "read", "--chip", chip, "b32", hex(address), "1"]
    try:
        done = subprocess.run(words, capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"error: probe-rs cannot be run: {error.strerror}")
    if done.returncode:
        sys.exit(f"error: probe-rs: {done.stderr.strip()}")
    try:
        return int(done.stdout.split()[-1].removeprefix("0x"), 16)
    except (IndexError, ValueError):
        sys.exit(f"error: probe-rs said no word: {done.stdout.strip()}")


def commit():
    """What was built, as far as git knows."""
    words = ["git", "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(words, capture_output=True, text=True)
    except OSError:
        return "unknown"
    return done.stdout.strip() or "unknown"


def main(chip, path, seconds="10"):
    try:
        address = Elf(path).address(COUNTER)
        wait = float(seconds)
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
    if address is None:
        sys.exit(f"error: {path} has no {COUNTER}: is it an example's ELF?")
    first, start = read_word(chip, address), time.monotonic()
    time.sleep(wait)
    last, took = read_word(chip, address), time.monotonic() - start
    frames = (last - first) % (1 << 32)
    print(f"{chip}: {frames} frames in {took:.2f} s, {frames / took:.2f} a second, {commit()}")


if __name__ == "__main__":
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
