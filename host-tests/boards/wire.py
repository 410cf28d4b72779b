"""What a board's emulator prints, line by line, for `scanbeam boards` to judge: see wire.mjs.

There is no time in these emulators, so neither `time` nor `figures` are printed.
"""

PIXELS = 0x2C
CHUNK = 4096
MOST_FAULTS = 20


class Wire:
    """The panel's end of the bus. It is over after the command that opens frame `frames` + 1."""

    def __init__(self, frames):
        self.left = frames + 1
        self.pending = bytearray()
        self.level = 0
        self.faults = set()
        self.why = None

    def flush(self):
        if self.pending:
            print("data", self.level, self.pending.hex())
        self.pending.clear()

    def bytes(self, values, level):
        """Bytes have arrived with this level of the data/command pin."""
        for value in values if not level else ():
            self.flush()
            self.level = 0
            self.pending.append(value)
            if value == PIXELS:
                self.left -= 1
                if not self.left:
                    self.end("frames")
        if level:
            if not self.level or len(self.pending) >= CHUNK:
                self.flush()
            self.level = 1
            self.pending += values

    def fault(self, text):
        """Each fault is said once."""
        if text in self.faults or self.why:
            return
        self.faults.add(text)
        print("fault", text)
        if len(self.faults) == MOST_FAULTS:
            self.end("too many faults")

    def end(self, why):
        if not self.why:
            self.flush()
            self.why = why

    def close(self):
        print("end", self.why, flush=True)


class Bus:
    """An SPI that sends: a queue for the processor, one transfer of a DMA, the data/command pin.

    Nothing takes time by itself: a byte arrives, or a transfer ends, at so many looks at a state.
    """

    LOOKS = 3

    def __init__(self, wire, depth):
        self.wire, self.depth = wire, depth
        self.queue = bytearray()
        self.level = 0
        self.looks = 0
        self.transfer = None
        self.ended = lambda: None  # called when a transfer ends

    def set_level(self, level):
        if level != self.level and (self.queue or self.transfer):
            self.wire.fault("D/C changed while a byte was on the bus")
        self.level = level

    def push(self, value):
        """The processor writes a byte."""
        if len(self.queue) >= self.depth:
            self.wire.fault("a byte is written to a full SPI")
        if self.transfer:
            self.wire.fault("the processor writes while the DMA sends")
        self.queue.append(value)

    def look(self):
        """The processor asks for the state of the bus."""
        self.looks += 1
        if self.looks % self.LOOKS == 0 and self.queue:
            self.wire.bytes(self.queue[:1], self.level)
            del self.queue[:1]

    def start(self, source):
        """A transfer: `source` reads the bytes that are in its buffer now."""
        if self.transfer:
            self.wire.fault("a transfer starts while one runs")
        first = bytes(source())
        if not self.level and len(first) > 1:
            self.wire.fault("DMA of pixels with D/C low")
        self.transfer = (source, first)
        self.looks = 0

    def look_at_transfer(self):
        """Whether it runs still. When it ends, the last bytes are in the queue."""
        if not self.transfer:
            return False
        self.looks += 1
        if self.looks <= self.LOOKS:
            return True
        source, first = self.transfer
        self.transfer = None
        if bytes(source()) != first:
            self.wire.fault("write into a buffer that is being sent")
        self.wire.bytes(self.queue, self.level)
        self.wire.bytes(first[: -self.depth], self.level)
        self.queue[:] = first[-self.depth :]
        self.ended()
        return False
