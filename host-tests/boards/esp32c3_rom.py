"""The functions of the ESP32-C3's ROM that the example calls, by the names of the ELF's symbols.

Arithmetic is the C library's: doubles hold the sum, difference, product and quotient of two floats
well enough that the second rounding is exact.
"""

import ctypes
import math
import struct


def to_float(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def to_bits(value):
    return struct.unpack("<I", struct.pack("<f", ctypes.c_float(value).value))[0]


def signed(value, bits):
    return value - (1 << bits) if value >> bits - 1 else value


def quotient(x, y):
    if y:
        return x / y
    return math.nan if x == 0 or math.isnan(x) else math.copysign(math.inf, x)


def divide(x, y):
    """Towards zero, as C does."""
    x, y = signed(x, 64), signed(y, 64)
    whole = abs(x) // abs(y)
    return whole if (x < 0) == (y < 0) else -whole


def to_integer(x, least, most):
    """Towards zero, to the nearest that there is."""
    return 0 if math.isnan(x) else max(least, min(most, int(max(-1e20, min(1e20, x)))))


def compared(if_unordered):
    def compare(x, y):
        if math.isnan(x) or math.isnan(y):
            return if_unordered
        return (x > y) - (x < y)

    return compare


FLOATS = {  # of two floats, a float
    "__addsf3": lambda x, y: x + y,
    "__subsf3": lambda x, y: x - y,
    "__mulsf3": lambda x, y: x * y,
    "__divsf3": quotient,
}
COMPARES = {  # of two floats, an integer
    "__unordsf2": lambda x, y: int(math.isnan(x) or math.isnan(y)),
    "__eqsf2": lambda x, y: int(x != y),
    "__nesf2": lambda x, y: int(x != y),
    "__ltsf2": compared(1),
    "__lesf2": compared(1),
    "__gtsf2": compared(-1),
    "__gesf2": compared(-1),
}
LONGS = {  # of two integers of 64 bits, a third
    "__udivdi3": lambda x, y: x // y,
    "__umoddi3": lambda x, y: x % y,
    "__divdi3": divide,
    "__muldi3": lambda x, y: x * y,
}
WORDS = {  # of one word, one or two
    "__fixsfsi": lambda x: to_integer(to_float(x), -(1 << 31), (1 << 31) - 1),
    "__fixunssfsi": lambda x: to_integer(to_float(x), 0, (1 << 32) - 1),
    "__fixsfdi": lambda x: to_integer(to_float(x), -(1 << 63), (1 << 63) - 1),
    "__floatsisf": lambda x: to_bits(signed(x, 32)),
    "__floatunsisf": to_bits,
    "rtc_get_reset_reason": lambda _: 1,
}
# Those that return two words.
WIDE = {*LONGS, "__fixsfdi"}
# What sets up clocks and waits for analogue parts: there are none.
QUIET = {
    "rom_i2c_writeReg",
    "rom_i2c_writeReg_Mask",
    "rom_i2c_readReg",
    "esp_rom_regi2c_read",
    "ets_delay_us",
    "ets_update_cpu_frequency",
}


def call(name, arguments, memory):
    """What a function returns, in 64 bits, or `None` when it is not known. `memory` can be read and
    written."""
    a, b, c, d = arguments
    if name in FLOATS:
        return to_bits(FLOATS[name](to_float(a), to_float(b)))
    if name in COMPARES:
        return COMPARES[name](to_float(a), to_float(b)) & 0xFFFFFFFF
    if name in LONGS:
        return LONGS[name](a | b << 32, c | d << 32) & (1 << 64) - 1
    if name in WORDS:
        return WORDS[name](a) & (1 << 64) - 1
    if name == "memset" and c:
        memory.mem_write(a, bytes([b & 0xFF]) * c)
    if name in ("memcpy", "memmove") and c:
        memory.mem_write(a, bytes(memory.mem_read(b, c)))
    if name in ("memset", "memcpy", "memmove"):
        return a
    return 0 if name in QUIET else None
