// What a loader needs of a 32-bit little-endian ELF: the bytes of its segments and where they go.
import fs from 'node:fs';

const PT_LOAD = 1;

/** Segments with bytes of their own, by the address that they are stored at. */
export function segments(file) {
  const bytes = fs.readFileSync(file);
  if (bytes.length < 52 || bytes.readUInt32BE(0) !== 0x7f454c46 || bytes[4] !== 1) {
    throw new Error(`${file} is no 32-bit ELF`);
  }
  const [table, size, count] = [bytes.readUInt32LE(28), bytes.readUInt16LE(42), bytes.readUInt16LE(44)];
  const found = [];
  for (let at = table; at < table + count * size; at += size) {
    const [kind, offset] = [bytes.readUInt32LE(at), bytes.readUInt32LE(at + 4)];
    const [address, length] = [bytes.readUInt32LE(at + 12), bytes.readUInt32LE(at + 16)];
    if (kind === PT_LOAD && length) {
      found.push({ address, data: bytes.subarray(offset, offset + length) });
    }
  }
  return found;
}
