"""The wire and the bus find the faults that they are for."""

import contextlib
import io
import unittest

from wire import Bus, Wire


def printed(act, frames=9):
    """What is printed while `act` uses a bus with a queue of two bytes."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        wire = Wire(frames)
        act(wire, Bus(wire, depth=2))
        wire.flush()
    return out.getvalue().splitlines()


def settle(bus):
    while bus.queue:
        bus.look()


class WireTest(unittest.TestCase):
    def test_bytes_arrive_with_the_level_of_the_pin(self):
        def act(_, bus):
            bus.push(0x3A)
            settle(bus)
            bus.set_level(1)
            bus.push(0x55)
            settle(bus)

        self.assertEqual(printed(act), ["data 0 3a", "data 1 55"])

    def test_a_run_ends_when_one_more_frame_opens(self):
        def act(wire, _):
            wire.bytes(b"\x2c", 0)
            wire.bytes(b"\x12\x34", 1)
            self.assertIsNone(wire.why)
            wire.bytes(b"\x2c", 0)
            self.assertEqual(wire.why, "frames")

        self.assertEqual(printed(act, frames=1), ["data 0 2c", "data 1 1234", "data 0 2c"])

    def test_the_pin_may_not_change_before_the_last_byte_is_out(self):
        def act(_, bus):
            bus.push(0x2C)
            bus.set_level(1)

        self.assertIn("fault D/C changed while a byte was on the bus", printed(act))

    def test_the_last_bytes_of_a_transfer_are_still_on_the_bus(self):
        def act(_, bus):
            bus.set_level(1)
            bus.start(lambda: b"abcd")
            while bus.look_at_transfer():
                pass
            bus.set_level(0)

        lines = printed(act)
        self.assertIn("fault D/C changed while a byte was on the bus", lines)
        self.assertIn("data 1 6162", lines)

    def test_a_buffer_that_is_sent_may_not_change(self):
        def act(_, bus):
            buffer = bytearray(b"abcd")
            bus.set_level(1)
            bus.start(lambda: buffer)
            buffer[3] = 0
            while bus.look_at_transfer():
                pass

        self.assertIn("fault write into a buffer that is being sent", printed(act))

    def test_a_full_queue_takes_no_more(self):
        def act(_, bus):
            for value in range(3):
                bus.push(value)

        self.assertIn("fault a byte is written to a full SPI", printed(act))

    def test_transfers_and_the_processor_do_not_mix(self):
        def act(_, bus):
            bus.start(lambda: b"abcd")
            bus.push(0)
            bus.start(lambda: b"abcd")

        faults = [line[6:] for line in printed(act) if line.startswith("fault ")]
        wanted = [
            "DMA of pixels with D/C low",
            "the processor writes while the DMA sends",
            "a transfer starts while one runs",
        ]
        self.assertEqual(faults, wanted)

    def test_a_fault_is_said_once_and_many_end_the_run(self):
        def act(wire, _):
            for number in range(40):
                wire.fault(f"number {number // 2}")
            self.assertEqual(wire.why, "too many faults")

        self.assertEqual(len(printed(act)), 20)


if __name__ == "__main__":
    unittest.main()
