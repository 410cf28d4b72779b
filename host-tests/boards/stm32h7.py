"""An STM32H743 as the example uses it: power, clocks, pins, and an LTDC that shows what lies in RAM.

A picture is what the LTDC reads from the vertical blank on in which it was given a frame, in the
order of a wire: the higher byte of each pixel first.
"""

import struct

from unicorn.arm_const import UC_CPU_ARM_CORTEX_M7

from machine import CortexM, arguments

FLASH, FLASH_SIZE = 0x08000000, 2 << 20
RAM, RAM_SIZE = 0x24000000, 512 << 10
WIDTH, HEIGHT, RGB565 = 320, 240, 2
RCC_CR, RCC_CFGR, RCC_CSR = 0x58024400, 0x58024410, 0x58024474
COMPENSATION = 0x58000420
PWR_CSR1, PWR_D3CR = 0x58024804, 0x58024818
LTDC = 0x50001000
BPCR, AWCR, TWCR, GCR, SRCR = (LTDC + at for at in (0x0C, 0x10, 0x14, 0x18, 0x24))
L1CR, L1WHPCR, L1WVPCR, L1PFCR = (LTDC + at for at in (0x84, 0x88, 0x8C, 0x94))
L1CFBAR, L1CFBLR, L1CFBLNR = (LTDC + at for at in (0xAC, 0xB0, 0xB4))
GCR_RESET = 0x2220
NOW, IN_BLANK = 1, 2  # when new settings are taken over
GPIO, GPIO_SIZE = 0x58020000, 0x400
# The pins of 16 bits of colour, clock, syncs and data enable: port, pin, function.
PINS = (
    *(("A", pin, 14) for pin in (3, 4, 5, 6, 12)),
    *(("B", pin, 9) for pin in (0, 1)),
    *(("B", pin, 14) for pin in (8, 9, 10, 11)),
    *(("C", pin, 14) for pin in (6, 7)),
    *(("D", pin, 14) for pin in (3, 10)),
    *(("E", pin, 14) for pin in (11, 12, 13, 14, 15)),
)
LOOKS = 3


def halves(value):
    """Horizontal and vertical: the LTDC's registers have both in one word."""
    return value >> 16 & 0xFFF, value & 0xFFF


class Chip(CortexM):
    def __init__(self, elf, frames):
        super().__init__(elf, frames, UC_CPU_ARM_CORTEX_M7, (FLASH, FLASH_SIZE), (RAM, RAM_SIZE))
        self.map_registers(0x40000000, 0x20000000)
        self.registers.update({GCR: GCR_RESET, RCC_CR: 1})  # the internal clock is on
        self.looks = 0
        self.shown = None  # a function that reads the shown frame, and what was there
        self.pictures = 0
        self.reads = {
            RCC_CR: self.clocks_ready,
            RCC_CFGR: lambda: self.get(RCC_CFGR) & ~0x38 | (self.get(RCC_CFGR) & 7) << 3,
            RCC_CSR: lambda: self.get(RCC_CSR) & 1 | (self.get(RCC_CSR) & 1) << 1,
            COMPENSATION: lambda: self.get(COMPENSATION) | 1 << 8,
            PWR_CSR1: lambda: 1 << 13 | self.get(PWR_D3CR) & 3 << 14,
            PWR_D3CR: lambda: self.get(PWR_D3CR) | 1 << 13,
            SRCR: self.look,
        }
        self.writes = {SRCR: self.take_over}

    def clocks_ready(self):
        """Each clock is ready when it is on."""
        value = self.get(RCC_CR)
        for on, ready in (0, 2), (3, 5), (7, 8), (12, 13), (16, 17), (24, 25), (26, 27), (28, 29):
            value = value & ~(1 << ready) | (value >> on & 1) << ready
        return value | 1 << 5  # and so is the divider of the internal one

    def take_over(self, value):
        self.registers[SRCR] = value
        self.looks = 0
        if value & IN_BLANK and self.pictures == self.frames:
            self.wire.end("frames")
        if value & NOW:
            self.registers[SRCR] = value & ~NOW
            self.show()

    def look(self):
        """The vertical blank comes at some look."""
        self.looks += 1
        if self.get(SRCR) & IN_BLANK and self.looks > LOOKS:
            self.registers[SRCR] &= ~IN_BLANK
            self.show()
            self.send()
        return self.get(SRCR)

    def show(self):
        """From now on the panel is fed from this frame, and nobody may write it."""
        if self.shown:
            source, before = self.shown
            self.check(bytes(source()) == before, "the frame that is shown was written to")
        for fault in self.faults():
            self.wire.fault(fault)
        source = self.memory(self.get(L1CFBAR), 2 * WIDTH * HEIGHT, RAM, RAM + RAM_SIZE)
        self.shown = source, bytes(source())

    def faults(self):
        """What a panel would not show, or show wrong."""
        (left, top), (right, bottom) = halves(self.get(BPCR)), halves(self.get(AWCR))
        total = halves(self.get(TWCR))
        across, down = self.get(L1WHPCR), self.get(L1WVPCR)
        window = (right - left, bottom - top)
        pitch, length = halves(self.get(L1CFBLR))
        checks = (
            (self.get(GCR) & 1, "the LTDC is off"),
            (self.get(L1CR) & 1, "the layer is off"),
            (self.get(L1PFCR) & 7 == RGB565, "the layer's pixels are not RGB565"),
            (window == (WIDTH, HEIGHT), f"the panel has {window} pixels"),
            (total[0] > right and total[1] > bottom, "there is no front porch"),
            (halves(across)[::-1] == (left + 1, right), "the layer is not as wide as the panel"),
            (halves(down)[::-1] == (top + 1, bottom), "the layer is not as high as the panel"),
            (pitch == 2 * WIDTH, f"lines are {pitch} bytes apart"),
            (length == 2 * WIDTH + 7, f"a line has {length} bytes, not {2 * WIDTH + 7}"),
            (self.get(L1CFBLNR) & 0x7FF == HEIGHT, "the layer has other lines than the panel"),
            (not self.get(L1CFBAR) & 1, "the frame is not aligned to pixels"),
        )
        yield from (text for holds, text in checks if not holds)
        for port, pin, function in PINS:
            base = GPIO + GPIO_SIZE * (ord(port) - ord("A"))
            mode = self.get(base) >> 2 * pin & 3
            chosen = self.get(base + 0x20 + 4 * (pin // 8)) >> 4 * (pin % 8) & 15
            if (mode, chosen) != (2, function):
                yield f"P{port}{pin} is not the LTDC's"

    def send(self):
        """A picture, as it came to the panel."""
        pixels = struct.unpack(f"<{WIDTH * HEIGHT}H", self.shown[1])
        print(f"picture {WIDTH} {HEIGHT} {struct.pack(f'>{WIDTH * HEIGHT}H', *pixels).hex()}")
        self.pictures += 1


if __name__ == "__main__":
    asked = arguments()
    Chip(asked.elf, asked.frames).boot(FLASH)
