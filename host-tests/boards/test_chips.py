"""The chips' registers: a transfer as it should be, and with one thing wrong each."""

import contextlib
import io
import os
import struct
import tempfile
import unittest

try:
    import unicorn  # noqa: F401
except ImportError as error:
    raise unittest.SkipTest("unicorn is missing") from error

import esp32c3
import esp32c3_rom
import rp2350
import rp2350_embassy
import stm32f4
import stm32h7


def elf(address, data):
    """A file with one segment."""
    header = b"\x7fELF\x01\x01\x01" + bytes(9)
    header += struct.pack("<HHIIIIIHHHHHH", 2, 40, 1, address, 52, 0, 0, 52, 32, 1, 40, 0, 0)
    return header + struct.pack("<8I", 1, 84, address, address, len(data), len(data), 5, 4) + data


def made(chip, flash, data):
    """A chip with this in its flash."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "elf")
        with open(path, "wb") as file:
            file.write(elf(flash, data))
        with contextlib.redirect_stdout(io.StringIO()):
            return chip(path, 1)


def faults_of(module, data, writes):
    """What a chip complains of when these registers are written."""
    chip = made(module.Chip, getattr(module, "FLASH", 0x42000000), data)
    with contextlib.redirect_stdout(io.StringIO()):
        for address, value in writes.items():
            chip.write(address, value)
    return chip.wire.faults


STM32F4 = {
    stm32f4.GPIOA_BSRR: stm32f4.DC,
    stm32f4.SPI_CR1: 1 << 6,
    stm32f4.SPI_CR2: 2,
    stm32f4.S3_NDTR: 64,
    stm32f4.S3_PAR: stm32f4.SPI_DR,
    stm32f4.S3_M0AR: stm32f4.RAM,
    stm32f4.S3_CR: 3 << 25 | 1 << 10 | 1 << 6 | 1,
}
RP2350 = {
    rp2350.RESETS: 0,
    rp2350.SIO + 0x18: rp2350.DC,
    rp2350.SPI_CR1: 2,
    rp2350.SPI_DMACR: 2,
    rp2350.DMA: rp2350.RAM,
    rp2350.DMA + 4: rp2350.SPI_DR,
    rp2350.DMA + 8: 64,
    rp2350.DMA + 12: rp2350.SPI0_TX << 17 | 1 << 4 | 1,
}
ESP32C3 = {
    esp32c3.GPIO_SET: esp32c3.DC,
    esp32c3.SPI_USER: 1 << 27,
    esp32c3.SPI_LENGTH: 8 * 64 - 1,
    esp32c3.SPI_DMA: 1 << 28,
    esp32c3.GDMA_PERIPHERAL: esp32c3.GDMA_SPI2,
    esp32c3.GDMA_LINK: esp32c3.DRAM & 0xFFFFF,
    esp32c3.SPI_CMD: 1 << 24,
}
IMAGE = bytes(16) + rp2350.IMAGE_BLOCK


class ChipTest(unittest.TestCase):
    def test_a_transfer_as_it_should_be(self):
        self.assertEqual(faults_of(stm32f4, bytes(8), STM32F4), set())
        self.assertEqual(faults_of(rp2350, IMAGE, RP2350), set())

    def find(self, module, data, good, changes):
        for address, value, fault in changes:
            with self.subTest(fault=fault):
                self.assertEqual(faults_of(module, data, {**good, address: value}), {fault})

    def test_faults_of_the_stm32f4(self):
        control = STM32F4[stm32f4.S3_CR]
        changes = (
            (stm32f4.GPIOA_BSRR, 0, "DMA of pixels with D/C low"),
            (stm32f4.SPI_CR2, 0, "SPI does not ask for DMA"),
            (stm32f4.S3_PAR, 0x40013010, "DMA writes to 40013010"),
            (stm32f4.S3_M0AR, stm32f4.FLASH, "DMA reads from 08000000"),
            (stm32f4.S3_CR, control ^ 1 << 25, "DMA has channel 2"),
            (stm32f4.S3_CR, control ^ 1 << 6, "DMA does not go from memory to the SPI"),
            (stm32f4.S3_CR, control ^ 1 << 10, "DMA does not step through its buffer"),
            (stm32f4.S3_CR, control ^ 1 << 13, "DMA is not 8 bits wide"),
        )
        self.find(stm32f4, bytes(8), STM32F4, changes)

    def test_faults_of_the_rp2350(self):
        control = RP2350[rp2350.DMA + 12]
        changes = (
            (rp2350.SIO + 0x18, 0, "DMA of pixels with D/C low"),
            (rp2350.SPI_DMACR, 0, "SPI does not ask for DMA"),
            (rp2350.RESETS, rp2350.DMA_RESET, "DMA is held in reset"),
            (rp2350.DMA, 0x14000000, "DMA reads from 14000000"),
            (rp2350.DMA + 4, rp2350.RAM, "DMA writes to 20000000"),
            (rp2350.DMA + 12, control ^ 1 << 17, "DMA has request line 25"),
            (rp2350.DMA + 12, control ^ 1 << 2, "DMA is not 8 bits wide"),
            (rp2350.DMA + 12, control ^ 1 << 4, "DMA does not step through its buffer alone"),
        )
        self.find(rp2350, IMAGE, RP2350, changes)
        no_image = faults_of(rp2350, bytes(8), RP2350)
        self.assertEqual(no_image, {"no image block for the boot ROM"})

    def test_faults_of_the_esp32c3(self):
        # Its descriptor is all zeros: not the DMA's, and of no buffer.
        wanted = {"a descriptor is not the DMA's", "descriptors end 64 bytes early"}
        found = faults_of(esp32c3, bytes(8), ESP32C3)
        self.assertLessEqual(wanted, found)
        other = faults_of(esp32c3, bytes(8), {**ESP32C3, esp32c3.GDMA_PERIPHERAL: 2})
        self.assertEqual(other - found, {"DMA has peripheral 2"})

    def test_a_byte_for_a_bus_that_is_off(self):
        fault = {"a byte is written to an SPI that is off"}
        self.assertEqual(faults_of(stm32f4, bytes(8), {stm32f4.SPI_DR: 1}), fault)
        self.assertEqual(faults_of(rp2350, IMAGE, {rp2350.SPI_DR: 1}), fault)


def ltdc_writes():
    """The LTDC of the example: 30 + 38 clocks and 3 + 15 lines before the picture."""
    writes = {
        stm32h7.BPCR: 67 << 16 | 17,
        stm32h7.AWCR: 387 << 16 | 257,
        stm32h7.TWCR: 407 << 16 | 261,
        stm32h7.GCR: 1,
        stm32h7.L1CR: 1,
        stm32h7.L1WHPCR: 387 << 16 | 68,
        stm32h7.L1WVPCR: 257 << 16 | 18,
        stm32h7.L1PFCR: 2,
        stm32h7.L1CFBAR: stm32h7.RAM,
        stm32h7.L1CFBLR: 640 << 16 | 647,
        stm32h7.L1CFBLNR: 240,
    }
    for port, pin, function in stm32h7.PINS:
        base = stm32h7.GPIO + stm32h7.GPIO_SIZE * (ord(port) - ord("A"))
        half = base + 0x20 + 4 * (pin // 8)
        writes[base] = writes.get(base, 0) | 2 << 2 * pin
        writes[half] = writes.get(half, 0) | function << 4 * (pin % 8)
    return writes


class LtdcTest(unittest.TestCase):
    def faults(self, change):
        writes = {**ltdc_writes(), **change, stm32h7.SRCR: stm32h7.NOW}
        return faults_of(stm32h7, bytes(8), writes)

    def test_a_panel_as_it_should_be(self):
        self.assertEqual(self.faults({}), set())

    def test_faults_of_the_ltdc(self):
        pins = stm32h7.GPIO + 3 * stm32h7.GPIO_SIZE  # port D
        for address, value, fault in (
            (stm32h7.GCR, 0, "the LTDC is off"),
            (stm32h7.L1CR, 0, "the layer is off"),
            (stm32h7.L1PFCR, 1, "the layer's pixels are not RGB565"),
            (stm32h7.TWCR, 387 << 16 | 261, "there is no front porch"),
            (stm32h7.L1WHPCR, 386 << 16 | 68, "the layer is not as wide as the panel"),
            (stm32h7.L1WVPCR, 257 << 16 | 17, "the layer is not as high as the panel"),
            (stm32h7.L1CFBLR, 638 << 16 | 647, "lines are 638 bytes apart"),
            (stm32h7.L1CFBLR, 640 << 16 | 640, "a line has 640 bytes, not 647"),
            (stm32h7.L1CFBLNR, 239, "the layer has other lines than the panel"),
            (stm32h7.L1CFBAR, stm32h7.RAM + 1, "the frame is not aligned to pixels"),
            (stm32h7.L1CFBAR, stm32h7.FLASH, "DMA reads from 08000000"),
            (pins, 2 << 6, "PD10 is not the LTDC's"),
        ):
            with self.subTest(fault=fault):
                self.assertEqual(self.faults({address: value}), {fault})

    def test_the_frame_that_is_shown_may_not_be_written(self):
        chip = made(stm32h7.Chip, stm32h7.FLASH, bytes(8))
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            for address, value in ltdc_writes().items():
                chip.write(address, value)
            chip.write(stm32h7.SRCR, stm32h7.NOW)
            chip.uc.mem_write(stm32h7.RAM + 8, b"\x34\x12")
            chip.write(stm32h7.SRCR, stm32h7.IN_BLANK)
            looks = [chip.read(stm32h7.SRCR) for _ in range(4)]
        self.assertEqual(looks, [stm32h7.IN_BLANK] * 3 + [0])
        self.assertEqual(chip.wire.faults, {"the frame that is shown was written to"})
        picture = out.getvalue().splitlines()[-1]
        self.assertTrue(picture.startswith("picture 320 240 00000000000000001234"))


class EmbassyTest(unittest.TestCase):
    def sent(self, draw):
        """What is reported of some bands, with `draw` called while each is sent."""
        chip = made(rp2350_embassy.EmbassyChip, rp2350.FLASH, IMAGE)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            for address, value in {**RP2350, rp2350_embassy.ENABLED: 1}.items():
                if address != rp2350.DMA + 12:
                    chip.write(address, value)
            for band in range(8):
                at = rp2350.RAM + band % 2 * 64
                chip.write(rp2350.DMA, at)
                chip.write(rp2350.DMA + 12, RP2350[rp2350.DMA + 12])
                draw(chip, rp2350.RAM + 64 - band % 2 * 64, band)
                raised = [chip.sleep() for _ in range(4)]
                self.assertEqual(raised, [None] * 3 + [rp2350_embassy.DMA_IRQ_0])
                chip.write(rp2350_embassy.RAISED, 1)
            chip.report()
        return out.getvalue().splitlines()[-2:]

    def test_a_band_is_drawn_while_another_is_sent(self):
        lines = self.sent(lambda chip, at, band: chip.uc.mem_write(at, bytes([band + 1])))
        self.assertEqual(lines[-1], "note in 7 of 7 transfers the next was drawn")

    def test_nothing_is_drawn_while_a_band_is_sent(self):
        lines = self.sent(lambda *_: None)
        self.assertEqual(lines[-1], "fault drawing and sending do not overlap")


class RomTest(unittest.TestCase):
    def test_arithmetic_is_that_of_c(self):
        def call(name, *words):
            return esp32c3_rom.call(name, (*words, 0, 0, 0, 0)[:4], None)

        one, third = 0x3F800000, 0x3EAAAAAB
        self.assertEqual(call("__divsf3", one, 0x40400000), third)
        self.assertEqual(call("__divsf3", one, 0), 0x7F800000)
        self.assertEqual(call("__fixsfsi", 0xC0200000), (1 << 64) - 2)  # -2.5, towards zero
        self.assertEqual(call("__fixunssfsi", 0xBF800000), 0)
        self.assertEqual(call("__ltsf2", one, 0x7FC00000), 1)
        self.assertEqual(call("__divdi3", 0xFFFFFFF9, 0xFFFFFFFF, 2, 0), (1 << 64) - 3)
        self.assertIsNone(call("printf"))


if __name__ == "__main__":
    unittest.main()
