// What a board's emulator prints, line by line, for `scanbeam boards` to judge:
//
//   time MICROSECONDS      when the command that follows arrived, where the emulator knows
//   data DC HEX            bytes that arrived with this level of the data/command pin
//   picture WIDTH HEIGHT HEX   what a memory-mapped panel shows from now on, as on a wire
//   clock HERTZ            of the processor, which the cycles are of
//   bus HERTZ              of the bus to the panel
//   stack BYTES            the most that core 0's stack had
//   divisions NUMBER       of all cores, by the chip's divider
//   figures CYCLES BUS WAIT MISSES   so far, when the pixels of a frame are about to come
//   use ADDRESS MISSES RETURNS   of what was read there since the first figures: see xip.mjs
//   fault TEXT             something that a chip or a panel would not forgive
//   note TEXT              for the reader
//   end TEXT               the last line: `frames` when all that were asked for have come
import fs from 'node:fs';

const PIXELS = 0x2c;
const CHUNK = 4096;
const MOST_FAULTS = 20;

export class Wire {
  /** Ends after the command that opens frame `frames` + 1. */
  constructor(frames, figures) {
    this.left = frames + 1;
    this.figures = figures;
    this.bytes = [];
    this.level = 0;
    this.faults = new Set();
    this.over = false;
  }

  say(line) {
    fs.writeSync(1, `${line}\n`);
  }

  flush() {
    if (this.bytes.length) this.say(`data ${this.level} ${Buffer.from(this.bytes).toString('hex')}`);
    this.bytes = [];
  }

  /** A byte has arrived. */
  byte(value, level, micros) {
    if (level !== this.level || this.bytes.length === CHUNK || !level) this.flush();
    this.level = level;
    if (!level) this.say(`time ${Math.round(micros)}`);
    this.bytes.push(value);
    if (!level && value === PIXELS) {
      this.say(`figures ${this.figures().map(Math.round).join(' ')}`);
      this.left--;
      if (!this.left) this.end('frames');
    }
  }

  /** Each fault is said once. */
  fault(text) {
    if (this.faults.has(text)) return;
    this.faults.add(text);
    if (!this.over) this.say(`fault ${text}`);
    if (this.faults.size === MOST_FAULTS) this.end('too many faults');
  }

  end(why) {
    if (this.over) return;
    this.flush();
    this.over = true;
    this.why = why;
  }

  /** After the last note. */
  close() {
    this.say(`end ${this.why}`);
  }
}
