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
    this.uses = undefined; // LineUses, where somebody asks
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
    this.uses?.missed(address);
    this.free = Math.max(cycle, this.free) + this.cost;
    return this.free;
  }
}

/** What is asked for, by address: misses, and how often a line of it is wanted after a while: in how
 * many periods it is read at all. A line that nobody reads for a period is taken to be gone from a
 * cache that others need, too, so that this tells what is worth its bytes in RAM, and wherever the
 * code lies now. Counts from `begin` on. */
export class LineUses {
  /** `period`: cycles. */
  constructor(period) {
    this.period = period;
    this.isOn = false;
    this.last = new Map(); // by line
    this.counts = new Map(); // by the address that was asked for
  }

  begin() {
    this.isOn = true;
  }

  read(address, cycle) {
    if (!this.isOn) return;
    const [line, now] = [address >>> LINE_SHIFT, Math.floor(cycle / this.period)];
    if (now <= (this.last.get(line) ?? -1)) return;
    this.last.set(line, now);
    this.of(address).returns++;
  }

  missed(address) {
    if (this.isOn) this.of(address).misses++;
  }

  of(address) {
    if (!this.counts.has(address)) this.counts.set(address, { misses: 0, returns: 0 });
    return this.counts.get(address);
  }
}
