"""What an emulator needs of a 32-bit little-endian ELF: segments, the entry, names of functions."""

import struct

PT_LOAD = 1
SHT_SYMTAB = 2


class Elf:
    """A file, read whole."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = file.read()
        if self.bytes[:5] != b"\x7fELF\x01":
            raise ValueError(f"{path} is no 32-bit ELF")
        self.entry, self.table, self.sections = struct.unpack_from("<3I", self.bytes, 24)
        sizes = struct.unpack_from("<5H", self.bytes, 42)
        self.segment_size, self.segment_count, self.section_size, self.section_count, _ = sizes

    def segments(self):
        """Address that it runs at, address that it is stored at, bytes."""
        for i in range(self.segment_count):
            at = self.table + i * self.segment_size
            kind, offset, runs, stored, size = struct.unpack_from("<5I", self.bytes, at)
            if kind == PT_LOAD and size:
                yield runs, stored, self.bytes[offset : offset + size]

    def section(self, i):
        """Type, offset, size, link."""
        at = self.sections + i * self.section_size
        fields = struct.unpack_from("<10I", self.bytes, at)
        return fields[1], fields[4], fields[5], fields[6]

    def names(self):
        """The names of symbols by address, without the bit that says Thumb."""
        found = {}
        for address, name in self.symbols():
            found.setdefault(address & ~1, name)
        return found

    def address(self, wanted):
        """Where a symbol is, or `None`."""
        return next((address for address, name in self.symbols() if name == wanted), None)

    def symbols(self):
        """Addresses and names."""
        for i in range(self.section_count):
            kind, offset, size, link = self.section(i)
            if kind != SHT_SYMTAB:
                continue
            strings = self.section(link)[1]
            for at in range(offset, offset + size, 16):
                name, value = struct.unpack_from("<2I", self.bytes, at)
                end = self.bytes.index(b"\0", strings + name)
                text = self.bytes[strings + name : end].decode("latin1")
                if text and not text.startswith("$"):
                    yield value, text
