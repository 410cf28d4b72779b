"""A chip on the processor emulator unicorn: memory, registers as a table, and a wire to a panel."""

import argparse
import struct
import sys

from unicorn import UC_ARCH_ARM, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError, arm_const as arm
from unicorn.unicorn_const import UC_ERR_INSN_INVALID

from elf import Elf
from wire import Wire

# A run that takes longer hangs; whole ones take a second, and a frame a part of one.
SECONDS, SECONDS_A_FRAME = 60, 5
COUNTER = "SCANBEAM_FRAMES"


def arguments():
    """`CHIP.py ELF FRAMES`"""
    parser = argparse.ArgumentParser()
    parser.add_argument("elf")
    parser.add_argument("frames", type=int)
    return parser.parse_args()


class Machine:
    """Registers keep what was written, unless `reads` or `writes` has a function for them."""

    def __init__(self, uc: Uc, elf: str, frames: int):
        self.uc = uc
        self.elf = Elf(elf)
        self.wire = Wire(frames)
        self.frames = frames
        self.seconds = SECONDS + frames * SECONDS_A_FRAME
        self.registers = {}
        self.reads = {}
        self.writes = {}

    def load(self, stored):
        """Puts the segments where they are stored (flash), or where they run."""
        for runs, at, data in self.elf.segments():
            self.uc.mem_write(at if stored else runs, data)

    def get(self, address):
        return self.registers.get(address, 0)

    def read(self, address):
        function = self.reads.get(address)
        return function() if function else self.registers.get(address, 0)

    def write(self, address, value):
        function = self.writes.get(address)
        if function:
            function(value)
        else:
            self.registers[address] = value
        if self.wire.why:
            self.uc.emu_stop()

    def map_registers(self, base, size):
        """Accesses below 32 bits are parts of the word, as on most buses."""

        def read(_, offset, width, __):
            address = base + offset
            value = self.read(address & ~3) >> 8 * (address & 3)
            return value & (1 << 8 * width) - 1

        def write(_, offset, width, value, __):
            address = base + offset
            if width < 4 and address & ~3 not in self.writes:
                shift = 8 * (address & 3)
                mask = (1 << 8 * width) - 1 << shift
                value = self.get(address & ~3) & ~mask | value << shift & mask
            self.write(address & ~3, value)

        self.uc.mmio_map(base, size, read, None, write, None)

    def memory(self, address, size, first, last):
        """A function that reads a buffer which must lie between `first` and `last`."""
        if not first <= address <= last - size:
            self.wire.fault(f"DMA reads from {address:08x}")
            return lambda: bytes(size)
        return lambda: self.uc.mem_read(address, size)

    def check(self, holds, text):
        if not holds:
            self.wire.fault(text)

    def where(self, pc):
        """The function around an address."""
        names = self.elf.names()
        return names.get(max((at for at in names if at <= pc), default=0), f"{pc:08x}")

    def report(self):
        """What is left to say at the end: whether the counter that a debug probe reads is right."""
        address = self.elf.address(COUNTER)
        if address is None:
            print("fault there is no counter of frames")
            return
        (counted,) = struct.unpack("<I", self.uc.mem_read(address, 4))
        if self.wire.why == "frames" and counted != self.frames:
            print(f"fault the counter says {counted} frames")

    def run(self, pc, pc_register, mend):
        """Runs until the wire is over. `mend` handles what the emulator cannot do, if it can, and
        says where to go on."""
        while not self.wire.why:
            try:
                self.uc.emu_start(pc, 0xFFFFFFFF, timeout=self.seconds * 1_000_000)
                stopped = self.where(self.uc.reg_read(pc_register))
                self.wire.end(f"nothing more came within {self.seconds} s, in {stopped}")
            except UcError as error:
                at = self.uc.reg_read(pc_register)
                pc = mend(error, at)
                if pc is None:
                    self.wire.end(f"{error} at {at:08x} in {self.where(at)}")
        self.report()
        self.wire.close()
        sys.exit(self.wire.why != "frames")


class CortexM(Machine):
    """A Cortex-M that starts by its vector table. It takes interrupts when it sleeps, and then
    alone: what the firmware does about them is the same."""

    NOP, YIELD, WFE = b"\x00\xbf", b"\x10\xbf", b"\x20\xbf"
    RETURN = 0xFFFFFFF9
    SYSTEM, SYSTEM_SIZE = 0xE0000000, 1 << 20  # the core's own registers, as plain memory
    VECTOR_TABLE = 0xE000ED08
    FRAME = 0x68  # what an exception may put on the stack

    def __init__(self, elf, frames, model, flash, ram):
        """`model` is unicorn's number of the core; flash and RAM are each a place and a size. The
        program lies in flash, and may use floats."""
        uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        uc.ctl_set_cpu_model(model)
        super().__init__(uc, elf, frames)
        for place, size in flash, ram, (self.SYSTEM, self.SYSTEM_SIZE):
            uc.mem_map(place, size)
        uc.reg_write(arm.UC_ARM_REG_C1_C0_2, 0xF << 20)
        uc.reg_write(arm.UC_ARM_REG_FPEXC, 1 << 30)
        self.load(stored=True)

    def boot(self, flash):
        self.flash = flash
        self.slept = None  # the state of the processor that an interrupt has left
        stack, pc = struct.unpack("<2I", self.uc.mem_read(flash, 8))
        self.uc.reg_write(arm.UC_ARM_REG_SP, stack)
        self.run(pc | 1, arm.UC_ARM_REG_PC, self.mend)

    def sleep(self):
        """The number of the interrupt that ends a sleep, or `None`: an event of the processor's own
        has ended it, as that of a task that wakes itself."""
        return None

    def mend(self, error, pc):
        """What the emulator cannot do: hints, sleep, interrupts."""
        if self.slept and pc & ~1 == self.RETURN & ~1:
            state, after = self.slept
            self.slept = None
            self.uc.context_restore(state)
            return after
        if error.errno != UC_ERR_INSN_INVALID:
            return None
        hint = bytes(self.uc.mem_read(pc - 2, 2))
        if hint == self.YIELD:
            self.uc.mem_write(pc - 2, self.NOP)
            self.uc.ctl_flush_tb()
            return pc | 1
        if hint != self.WFE:
            return None
        number = self.sleep()
        return pc | 1 if number is None else self.interrupt(number, pc | 1)

    def interrupt(self, number, after):
        """Enters the handler of an interrupt; all registers are kept until it returns."""
        self.slept = self.uc.context_save(), after
        stack = (self.uc.reg_read(arm.UC_ARM_REG_SP) - self.FRAME) & ~7
        self.uc.reg_write(arm.UC_ARM_REG_SP, stack)
        self.uc.reg_write(arm.UC_ARM_REG_LR, self.RETURN)
        (table,) = struct.unpack("<I", self.uc.mem_read(self.VECTOR_TABLE, 4))
        vector = (table or self.flash) + 4 * (16 + number)
        return struct.unpack("<I", self.uc.mem_read(vector, 4))[0]
