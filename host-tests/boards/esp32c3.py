"""An ESP32-C3 as the example uses it: start-up by esp-hal, ROM functions, SPI2 and its DMA."""

import struct

from unicorn import UC_ARCH_RISCV, UC_HOOK_CODE, UC_MODE_RISCV32, Uc
from unicorn.riscv_const import UC_RISCV_REG_A0, UC_RISCV_REG_A1, UC_RISCV_REG_PC
from unicorn.unicorn_const import UC_ERR_EXCEPTION, UC_ERR_INSN_INVALID

import esp32c3_rom as rom
from machine import Machine, arguments
from wire import Bus

ROM, ROM_SIZE = 0x40000000, 0x60000
DRAM, DRAM_END = 0x3FC80000, 0x3FCE0000
MEMORY = (
    (0x3C000000, 4 << 20),  # flash, as data
    (0x42000000, 4 << 20),  # flash, as code
    (ROM, ROM_SIZE),
    (0x3FF00000, 0x20000),  # ROM, as data
    (DRAM, 0x60000),
    (0x40378000, 0x68000),  # RAM, as code
    (0x50000000, 0x2000),
)
GPIO_OUT, GPIO_SET, GPIO_CLEAR = 0x60004004, 0x60004008, 0x6000400C
DC = 1 << 5  # GPIO5
TIMER_CALIBRATION, TIMER_RESULT, TIMER_LATER = 0x6001F068, 0x6001F06C, 0x6001F080
SYSTEM_TIMER_OP, SYSTEM_TIMER_HIGH, SYSTEM_TIMER_LOW = 0x60023004, 0x60023040, 0x60023044
TICKS_A_LOOK = 1600  # 100 us
SPI_CMD, SPI_USER, SPI_LENGTH, SPI_DMA = 0x60024000, 0x60024010, 0x6002401C, 0x60024030
SPI_WORDS = 0x60024098
GDMA_RAW, GDMA_CLEAR, GDMA_LINK = 0x6003F000, 0x6003F00C, 0x6003F0E0
GDMA_PERIPHERAL, GDMA_SPI2 = 0x6003F100, 0
SLOW_CLOCK, CRYSTAL = 136e3, 40e6
# CSRs that the emulator applies other rules to: memory protection and debug triggers.
PROTECTION = (*range(0x3A0, 0x3C0), *range(0x7A0, 0x7B0))
NOP, RET = struct.pack("<I", 0x13), struct.pack("<I", 0x8067)
SYSTEM = 0x73


class Chip(Machine):
    def __init__(self, elf, frames):
        super().__init__(Uc(UC_ARCH_RISCV, UC_MODE_RISCV32), elf, frames)
        for base, size in MEMORY:
            self.uc.mem_map(base, size)
        self.uc.mem_write(ROM, RET * (ROM_SIZE // 4))
        self.load(stored=False)
        self.names = self.elf.names()
        self.drop_protection()
        self.map_registers(0x60000000, 0x100000)
        self.uc.hook_add(UC_HOOK_CODE, self.in_rom, begin=ROM, end=ROM + ROM_SIZE - 1)
        self.bus = Bus(self.wire, depth=64)
        self.ticks = 0
        self.registers[GDMA_PERIPHERAL] = 63  # none
        self.reads = {
            TIMER_CALIBRATION: lambda: self.get(TIMER_CALIBRATION) | 1 << 15,
            TIMER_RESULT: self.calibration,
            TIMER_LATER: lambda: self.get(TIMER_LATER) & ~1,
            SYSTEM_TIMER_OP: lambda: self.get(SYSTEM_TIMER_OP) | 1 << 29,
            SYSTEM_TIMER_LOW: lambda: self.ticks & 0xFFFFFFFF,
            SYSTEM_TIMER_HIGH: lambda: self.ticks >> 32,
            SPI_CMD: self.spi_state,
        }
        self.writes = {
            GPIO_OUT: self.set_pins,
            GPIO_SET: lambda value: self.set_pins(self.get(GPIO_OUT) | value),
            GPIO_CLEAR: lambda value: self.set_pins(self.get(GPIO_OUT) & ~value),
            SYSTEM_TIMER_OP: self.take_time,
            GDMA_CLEAR: self.clear,
            SPI_CMD: self.command,
        }

    def drop_protection(self):
        """Writes of the CSRs of memory protection become nothing."""
        for runs, _, data in self.elf.segments():
            if not 0x40000000 <= runs < 0x44000000:
                continue
            for at in range(0, len(data) - 3, 2):
                (word,) = struct.unpack_from("<I", data, at)
                is_write = word & 0x7F == SYSTEM and word >> 12 & 7 in (1, 2, 3)
                if is_write and not word >> 7 & 31 and word >> 20 in PROTECTION:
                    self.uc.mem_write(runs + at, NOP)

    def in_rom(self, uc, address, _, __):
        name = self.names.get(address, f"{address:08x}")
        values = [uc.reg_read(UC_RISCV_REG_A0 + i) for i in range(4)]
        result = rom.call(name, values, uc)
        self.check(result is not None, f"the function {name} of the ROM is not known")
        uc.reg_write(UC_RISCV_REG_A0, (result or 0) & 0xFFFFFFFF)
        if name in rom.WIDE:
            uc.reg_write(UC_RISCV_REG_A1, (result or 0) >> 32 & 0xFFFFFFFF)

    def calibration(self):
        """So many crystal clocks as the asked number of slow clocks takes."""
        clocks = self.get(TIMER_CALIBRATION) >> 16 & 0x7FFF
        return int(clocks * CRYSTAL / SLOW_CLOCK) << 7 | 1

    def take_time(self, value):
        """Time goes on whenever it is asked for."""
        self.registers[SYSTEM_TIMER_OP] = value
        self.ticks += TICKS_A_LOOK

    def set_pins(self, value):
        self.registers[GPIO_OUT] = value
        self.bus.set_level(int(bool(value & DC)))

    def clear(self, value):
        self.registers[GDMA_RAW] = self.get(GDMA_RAW) & ~value

    def command(self, value):
        """Bit 23 takes the settings over, bit 24 sends."""
        self.registers[SPI_CMD] = value & ~(1 << 23)
        if not value & 1 << 24 or not self.get(SPI_USER) & 1 << 27:
            return
        size = ((self.get(SPI_LENGTH) & 0x3FFFF) + 1) // 8
        if self.get(SPI_DMA) & 1 << 28:
            self.bus.start(self.described(size))
        else:
            words = (self.get(SPI_WORDS + 4 * i) for i in range(16))
            for byte in b"".join(struct.pack("<I", word) for word in words)[:size]:
                self.bus.push(byte)

    def described(self, size):
        """The buffers that the DMA's descriptors name."""
        peripheral = self.get(GDMA_PERIPHERAL) & 63
        self.check(peripheral == GDMA_SPI2, f"DMA has peripheral {peripheral}")
        at, parts, left = 0x3FC00000 | self.get(GDMA_LINK) & 0xFFFFF, [], size
        while at and left > 0:
            flags, buffer, following = struct.unpack("<3I", self.uc.mem_read(at, 12))
            self.check(flags >> 31, "a descriptor is not the DMA's")
            taken = min(flags >> 12 & 0xFFF, left)
            parts.append(self.memory(buffer, taken, DRAM, DRAM_END))
            at, left = following, left - taken
        self.check(not left, f"descriptors end {left} bytes early")
        return lambda: b"".join(bytes(part()) for part in parts)

    def spi_state(self):
        """Sending ends after some looks, and with it all is out: the HAL asks the bus too."""
        if self.bus.transfer:
            if not self.bus.look_at_transfer():
                self.wire.bytes(self.bus.queue, self.bus.level)
                self.bus.queue.clear()
                self.registers[GDMA_RAW] = self.get(GDMA_RAW) | 0b1011000
        elif self.bus.queue:
            self.bus.look()
        if not self.bus.transfer and not self.bus.queue:
            self.registers[SPI_CMD] = self.get(SPI_CMD) & ~(1 << 24)
        return self.get(SPI_CMD)

    def skip_csr(self, error, pc):
        """A CSR that the emulator lacks reads 0."""
        if error.errno not in (UC_ERR_EXCEPTION, UC_ERR_INSN_INVALID):
            return None
        (word,) = struct.unpack("<I", self.uc.mem_read(pc, 4))
        if word & 0x7F != SYSTEM:
            return None
        if word >> 7 & 31:
            self.uc.reg_write(UC_RISCV_REG_A0 - 10 + (word >> 7 & 31), 0)
        return pc + 4

    def boot(self):
        self.run(self.elf.entry, UC_RISCV_REG_PC, self.skip_csr)


if __name__ == "__main__":
    asked = arguments()
    Chip(asked.elf, asked.frames).boot()
