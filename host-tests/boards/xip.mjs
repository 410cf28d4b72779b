// A model of the RP2040's flash cache: 16 KB, 2 ways, lines of 8 bytes, the older way is replaced.
// A miss costs so many cycles, and the flash serves one at a time, for both cores. True timing also
// depends on the flash chip and on the bus fabric, which nothing here knows.

const LINE_SHIFT = 3;
const SET_BITS = 10;

export class FlashCache {
  /** `cost`: cycles of a miss. */
  constructor(cost) {
    this.cost = cost;
    this.tags = new Int32Array(2 << SET_BITS).fill(-1);
    this.older = new Uint8Array(1 << SET_BITS);
    this.free = 0; // cycle from which the flash is free
    this.misses = 0;
  }

  /** The cycle at which what is asked for at `cycle` is there. */
  access(address, cycle) {
    const line = (address & 0xffffff) >>> LINE_SHIFT;
    const set = line & ((1 << SET_BITS) - 1);
    const tag = line >>> SET_BITS;
    for (let way = 0; way < 2; way++) {
      if (this.tags[2 * set + way] === tag) {
        this.older[set] = 1 - way;
        return cycle;
      }
    }
    const way = this.older[set];
    this.tags[2 * set + way] = tag;
    this.older[set] = 1 - way;
    this.misses++;
    this.free = Math.max(cycle, this.free) + this.cost;
    return this.free;
  }
}
