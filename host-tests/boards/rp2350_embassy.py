"""The RP2350 as embassy uses it: a timer, and a DMA whose end is an interrupt that ends a sleep.

The task has to draw a band while the one before is sent: it is counted in how many transfers the
buffer that is not sent has changed until their end.
"""

from machine import arguments
from rp2350 import DMA, FLASH, Chip

TIMER0 = 0x400B0000
TIME_HIGH, TIME_LOW = TIMER0 + 0x24, TIMER0 + 0x28
MICROS_A_LOOK = 100
ENABLED, RAISED = DMA + 0x404, DMA + 0x40C
DMA_IRQ_0 = 10
CHANNEL_0 = 1


class EmbassyChip(Chip):
    def __init__(self, elf, frames):
        super().__init__(elf, frames)
        self.micros = 0
        self.sent = None  # the buffer that was sent last
        self.beside = None  # the buffer that is not sent now, and what it held at the start
        self.overlaps = self.transfers_seen = 0
        self.bus.ended = self.transfer_ended
        self.reads[TIME_HIGH] = lambda: self.micros >> 32
        self.reads[TIME_LOW] = self.time
        self.writes[RAISED] = self.clear

    def time(self):
        self.micros += MICROS_A_LOOK
        return self.micros & 0xFFFFFFFF

    def clear(self, value):
        self.registers[RAISED] = self.get(RAISED) & ~value

    def start(self):
        super().start()
        buffer = self.bus.transfer[0]
        if len(self.bus.transfer[1]) > 16:  # pixels, no command
            self.beside = self.sent and (self.sent, bytes(self.sent()))
            self.sent = buffer

    def transfer_ended(self):
        self.registers[RAISED] = self.get(RAISED) | self.get(ENABLED) & CHANNEL_0
        if self.beside:
            buffer, before = self.beside
            self.transfers_seen += 1
            self.overlaps += bytes(buffer()) != before
            self.beside = None

    def sleep(self):
        """Time goes on; the end of a transfer is all that may come."""
        self.bus.look_at_transfer()
        return DMA_IRQ_0 if self.get(RAISED) else None

    def report(self):
        super().report()
        print(f"note in {self.overlaps} of {self.transfers_seen} transfers the next was drawn")
        # Where a band is as it was two bands before, at the top and the bottom, none is seen.
        if 4 * self.overlaps < self.transfers_seen:
            print("fault drawing and sending do not overlap")


if __name__ == "__main__":
    asked = arguments()
    EmbassyChip(asked.elf, asked.frames).boot(FLASH)
