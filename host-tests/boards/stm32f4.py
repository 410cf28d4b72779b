"""An STM32F411 as the example uses it: clocks, GPIOA, SPI1 and stream 3 of DMA2."""

from unicorn.arm_const import UC_CPU_ARM_CORTEX_M4

from machine import CortexM, arguments
from wire import Bus

FLASH, FLASH_SIZE = 0x08000000, 512 << 10
RAM, RAM_SIZE = 0x20000000, 128 << 10
PERIPHERALS, ALIASES = 0x40000000, 0x42000000
PWR_CSR = 0x40007004
SPI_CR1, SPI_CR2, SPI_SR, SPI_DR = 0x40013000, 0x40013004, 0x40013008, 0x4001300C
GPIOA_ODR, GPIOA_BSRR = 0x40020014, 0x40020018
RCC_CR, RCC_CFGR = 0x40023800, 0x40023808
DMA_LISR, DMA_LIFCR = 0x40026400, 0x40026408
S3_CR, S3_NDTR, S3_PAR, S3_M0AR = 0x40026458, 0x4002645C, 0x40026460, 0x40026464
DC = 1 << 1  # PA1


class Chip(CortexM):
    def __init__(self, elf, frames):
        super().__init__(elf, frames, UC_CPU_ARM_CORTEX_M4, (FLASH, FLASH_SIZE), (RAM, RAM_SIZE))
        self.map_registers(PERIPHERALS, 0x80000)
        self.map_aliases()
        self.bus = Bus(self.wire, depth=2)
        self.done = False
        self.reads = {
            RCC_CR: self.clocks_ready,
            RCC_CFGR: lambda: self.get(RCC_CFGR) & ~0xC | (self.get(RCC_CFGR) & 3) << 2,
            PWR_CSR: lambda: 1 << 14,
            SPI_SR: self.spi_state,
            DMA_LISR: self.dma_state,
        }
        self.writes = {
            GPIOA_ODR: self.set_pins,
            GPIOA_BSRR: lambda v: self.set_pins(self.get(GPIOA_ODR) & ~(v >> 16) | v & 0xFFFF),
            SPI_DR: self.send,
            DMA_LIFCR: self.clear,
            S3_CR: self.control,
        }

    def map_aliases(self):
        """The bits of registers as words: the HAL sets clocks so."""

        def place(offset):
            return PERIPHERALS + (offset >> 5 & ~3), offset >> 2 & 31

        def read(_, offset, __, ___):
            address, bit = place(offset)
            return self.read(address) >> bit & 1

        def write(_, offset, __, value, ___):
            address, bit = place(offset)
            self.write(address, self.get(address) & ~(1 << bit) | (value & 1) << bit)

        self.uc.mmio_map(ALIASES, 0x1000000, read, None, write, None)

    def clocks_ready(self):
        """Each clock is ready when it is on."""
        value = self.get(RCC_CR)
        for on, ready in (0, 1), (16, 17), (24, 25), (26, 27):
            value = value & ~(1 << ready) | (value >> on & 1) << ready
        return value

    def set_pins(self, value):
        self.registers[GPIOA_ODR] = value
        self.bus.set_level(int(bool(value & DC)))

    def send(self, value):
        self.check(self.get(SPI_CR1) & 1 << 6, "a byte is written to an SPI that is off")
        self.bus.push(value & 0xFF)

    def spi_state(self):
        queue = self.bus.queue
        state = (2 if len(queue) < self.bus.depth else 0) | (0x80 if queue else 0)
        self.bus.look()
        return state

    def dma_state(self):
        if self.bus.transfer and not self.bus.look_at_transfer():
            self.done = True
            self.registers[S3_CR] &= ~1
        return 1 << 27 if self.done else 0

    def clear(self, value):
        self.done = self.done and not value & 1 << 27

    def control(self, value):
        starts = value & 1 and not self.get(S3_CR) & 1
        self.registers[S3_CR] = value
        if not starts:
            return
        self.check(self.get(S3_PAR) == SPI_DR, f"DMA writes to {self.get(S3_PAR):08x}")
        self.check(value >> 25 & 7 == 3, f"DMA has channel {value >> 25 & 7}")
        self.check(value >> 6 & 3 == 1, "DMA does not go from memory to the SPI")
        self.check(value & 1 << 10, "DMA does not step through its buffer")
        self.check(not value >> 11 & 15, "DMA is not 8 bits wide")
        self.check(self.get(SPI_CR2) & 2, "SPI does not ask for DMA")
        self.check(not self.done, "the DMA's flag was not cleared")
        size = self.get(S3_NDTR) & 0xFFFF
        self.bus.start(self.memory(self.get(S3_M0AR), size, RAM, RAM + RAM_SIZE))


if __name__ == "__main__":
    asked = arguments()
    Chip(asked.elf, asked.frames).boot(FLASH)
