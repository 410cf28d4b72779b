"""One core of an RP2350 as the example uses it: clocks, resets, GPIO, SPI0 and the DMA."""

from unicorn.arm_const import UC_CPU_ARM_CORTEX_M33

from machine import CortexM, arguments
from wire import Bus

FLASH, FLASH_SIZE = 0x10000000, 4 << 20
RAM, RAM_SIZE = 0x20000000, 520 << 10
IMAGE_BLOCK = 0xFFFFDED3.to_bytes(4, "little")
CLOCKS = 0x40010000
RESETS, RESET_DONE, ALL_RESET = 0x40020000, 0x40020008, 0x1FFFFFFF
XOSC_STATUS = 0x40048004
PLLS = 0x40050000, 0x40058000
SPI_CR0, SPI_CR1, SPI_DR, SPI_SR = 0x40080000, 0x40080004, 0x40080008, 0x4008000C
SPI_CPSR, SPI_DMACR = 0x40080010, 0x40080024
CRYSTAL = 12_000_000
DMA, DMA_RESET, SPI0_TX = 0x50000000, 1 << 2, 24
SIO = 0xD0000000
DC = 1 << 4  # GP4
BUSY = 1 << 26
# A channel's four registers (Read, Write, Count, Control) in the order of each of its aliases; the
# last of each starts it.
ALIASES = "RWCT", "TRWC", "TCRW", "TWCR"


class Chip(CortexM):
    def __init__(self, elf, frames):
        super().__init__(elf, frames, UC_CPU_ARM_CORTEX_M33, (FLASH, FLASH_SIZE), (RAM, RAM_SIZE))
        self.check(IMAGE_BLOCK in self.uc.mem_read(FLASH, 4096), "no image block for the boot ROM")
        for base, size in (0x40000000, 0x170000), (DMA, 0x10000), (SIO, 0x1000):
            self.map_registers(base, size)
        self.bus = Bus(self.wire, depth=8)
        self.answers = 0  # bytes in the receive queue
        self.channel = dict.fromkeys("RWCT", 0)
        self.registers[RESETS] = ALL_RESET
        self.reads = {
            RESET_DONE: lambda: ~self.get(RESETS) & ALL_RESET,
            XOSC_STATUS: lambda: 1 << 31 | 1 << 12,
            SPI_SR: self.spi_state,
            SPI_DR: self.answer,
            **{pll: lambda pll=pll: self.get(pll) | 1 << 31 for pll in PLLS},
            **{SIO + 0x100 + 4 * i: lambda i=i: 1 << i for i in range(32)},
        }
        self.writes = {SPI_DR: self.send}
        self.clocks()
        self.pins()
        self.transfers()

    def map_registers(self, base, size):
        """All but SIO have aliases that flip, set and clear bits; narrow writes are repeated."""

        def read(_, offset, width, __):
            address = base + offset
            word = address & ~3 & ~(0 if base == SIO else 0x3000)
            return self.read(word) >> 8 * (address & 3) & (1 << 8 * width) - 1

        def write(_, offset, width, value, __):
            how = 0 if base == SIO else offset >> 12 & 3
            word = base + (offset & ~3) - (how << 12)
            value *= {1: 0x01010101, 2: 0x10001, 4: 1}[width]
            old = self.get(word)
            self.write(word, (value, old ^ value, old | value, old & ~value)[how] & 0xFFFFFFFF)

        self.uc.mmio_map(base, size, read, None, write, None)

    def clocks(self):
        """A clock's source is the one that was asked for."""
        for at in range(0, 10):
            control, selected = CLOCKS + 12 * at, CLOCKS + 12 * at + 8
            mask = {4: 3, 5: 1}.get(at, 0)
            self.reads[selected] = lambda control=control, mask=mask: 1 << (
                self.get(control) & mask
            )

    def pins(self):
        out = SIO + 0x10
        change = {
            0x10: lambda old, value: value,
            0x18: lambda old, value: old | value,
            0x20: lambda old, value: old & ~value,
            0x28: lambda old, value: old ^ value,
        }
        for offset, new in change.items():

            def write(value, new=new):
                self.registers[out] = new(self.get(out), value)
                self.bus.set_level(int(bool(self.get(out) & DC)))

            self.writes[SIO + offset] = write

    def report(self):
        super().report()
        print("bus", self.bus_hertz())

    def bus_hertz(self):
        """SPI0 divides the system's clock, which a PLL makes of the crystal's."""
        state, feedback, posts = (self.get(PLLS[0] + offset) for offset in (0, 8, 12))
        divider = (state & 63) * (posts >> 16 & 7) * (posts >> 12 & 7)
        divider *= (self.get(SPI_CPSR) & 0xFF) * (1 + (self.get(SPI_CR0) >> 8 & 0xFF))
        return CRYSTAL * feedback // max(1, divider)

    def send(self, value):
        self.check(self.get(SPI_CR1) & 2, "a byte is written to an SPI that is off")
        self.bus.push(value & 0xFF)

    def answer(self):
        """The bus answers each byte, with nothing."""
        self.answers = max(0, self.answers - 1)
        return 0

    def spi_state(self):
        queue, before = self.bus.queue, len(self.bus.queue)
        state = 0 if queue else 1
        state |= 2 if len(queue) < self.bus.depth else 0
        state |= 4 if self.answers else 0
        state |= 8 if self.answers == 8 else 0
        state |= 16 if queue or self.bus.transfer else 0
        self.bus.look()
        self.answers = min(8, self.answers + before - len(queue))
        return state

    def transfers(self):
        """Channel 0: each word of an alias is one of its four registers."""
        for alias, order in enumerate(ALIASES):
            for i, name in enumerate(order):
                address = DMA + 16 * alias + 4 * i

                def write(value, name=name, last=i == 3):
                    self.channel[name] = value
                    if last and self.channel["T"] & 1:
                        self.start()

                self.writes[address] = write
                self.reads[address] = lambda name=name: self.channel[name]
                if name == "T":
                    self.reads[address] = self.dma_state

    def dma_state(self):
        busy = self.bus.look_at_transfer()
        if not busy:
            self.answers = 8
        return self.channel["T"] & ~BUSY | (BUSY if busy else 0)

    def start(self):
        control, target = self.channel["T"], self.channel["W"]
        self.check(target == SPI_DR, f"DMA writes to {target:08x}")
        self.check(not control >> 2 & 3, "DMA is not 8 bits wide")
        self.check(control >> 4 & 7 == 1, "DMA does not step through its buffer alone")
        line = control >> 17 & 63
        self.check(line == SPI0_TX, f"DMA has request line {line}")
        self.check(self.get(SPI_DMACR) & 2, "SPI does not ask for DMA")
        self.check(not self.get(RESETS) & DMA_RESET, "DMA is held in reset")
        size, source = self.channel["C"] & 0xFFFFFFF, self.channel["R"]
        if FLASH <= source < FLASH + FLASH_SIZE:  # which this DMA can read, too
            self.bus.start(self.memory(source, size, FLASH, FLASH + FLASH_SIZE))
        else:
            self.bus.start(self.memory(source, size, RAM, RAM + RAM_SIZE))


if __name__ == "__main__":
    asked = arguments()
    Chip(asked.elf, asked.frames).boot(FLASH)
