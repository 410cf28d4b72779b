// An RP2040 with both cores, over rp2040js, which has one core, no MPU and no mailbox.
//
// Added here: the second core and its start, the mailbox, a divider and interpolators for each core,
// the MPU's registers with the stack guard, events (SEV, WFE), the flash cache's cost, an SPI whose
// bytes take their time, and complaints. Core 1 goes through the chip's own boot ROM.
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { FlashCache } from './xip.mjs';
import { segments } from './elf.mjs';

const FLASH = 0x10000000;
const FLASH_END = 0x14000000;
const RAM = 0x20000000;
const RAM_END = 0x20042000;
const PSM = 0x40010;
const RESETS = 0x4000c;
const SPI0_DATA = 0x4003c008;
const SPI_STATE = 0xc;
const SPI_BUSY = 1 << 4;
const DREQ_SPI0_TX = 16;
const DC_PIN = 4;
const FIFO_DEPTH = 8;
// Of SIO: a division begins as one of these is written.
const [DIVISOR, SIGNED_DIVISOR] = [0x64, 0x6c];
// A read of the DMA's state that follows the one before within so many cycles is a wait.
const POLL = 200;

/** The modules of the package below `folder`; not all are exported by its index. */
async function emulator(folder) {
  const resolve = createRequire(path.join(path.resolve(folder), 'any.js')).resolve;
  const root = path.join(path.dirname(resolve('rp2040js')), '..', 'esm');
  const load = (name) => import(pathToFileURL(path.join(root, name)).href);
  const [{ RP2040 }, { CortexM0Core }, { Interpolator }, { GPIOPinState }] = await Promise.all(
    ['rp2040.js', 'cortex-m0-core.js', 'interpolator.js', 'gpio-pin.js'].map(load),
  );
  return { RP2040, CortexM0Core, Interpolator, GPIOPinState };
}

export class Board {
  static async load({ packages, elf, bootrom, missCost, wire }) {
    return new Board(await emulator(packages), { elf, bootrom, missCost, wire });
  }

  constructor(parts, { elf, bootrom, missCost, wire }) {
    this.wire = wire;
    this.now = 0; // cycles of clk_sys, of the core that is behind
    this.selected = 0;
    this.event = false;
    this.held = true;
    this.slept = [0, 0];
    this.divided = [0, 0]; // divisions of each core
    this.polled = 0; // cycles in which core 0 polls the DMA
    this.busCycles = 0;
    const mcu = (this.mcu = new parts.RP2040());
    mcu.logger = {
      debug() {},
      info: (_, text) => { if (text === 'SEV') this.event = true; },
      warn: (name, text) => this.unknown(`${name}: ${text}`),
      error: (name, text) => wire.fault(`${name}: ${text}`),
    };
    mcu.onBreak = () => {
      this.stop(`core ${this.selected} stopped at ${hex(this.cores[this.selected].PC)}`);
    };
    mcu.loadBootrom(new Uint32Array(bootrom.buffer, bootrom.byteOffset, bootrom.length / 4));
    for (const { address, data } of segments(elf)) mcu.flash.set(data, address - FLASH);
    this.cores = [mcu.core, new parts.CortexM0Core(mcu)];
    this.cache = new FlashCache(missCost);
    this.lowest = [RAM_END, RAM_END];
    this.mailbox(parts);
    this.guards();
    this.powerSwitch();
    this.cores.forEach((core, i) => this.memory(core, i));
    this.transfers();
    this.bus(parts);
    this.cores[0].PC = FLASH; // the second-stage loader, where the boot ROM would go
    this.startCore1(); // on the chip it waits in the boot ROM, too
  }

  unknown(text) {
    this.unknowns ??= new Set();
    this.unknowns.add(text);
  }

  stop(why) {
    this.wire.end(why);
  }

  /** SIO: the number of the core, the mailbox between both, and what each has for itself. */
  mailbox(parts) {
    const { sio } = this.mcu;
    const own = () => ({
      divDividend: 0, divDivisor: 1, divQuotient: 0, divRemainder: 0, divCSR: 0,
      interp0: new parts.Interpolator(0), interp1: new parts.Interpolator(1),
    });
    this.own = [own(), own()];
    Object.assign(sio, this.own[0]);
    this.letters = [[], []]; // by who reads them
    this.letterErrors = [0, 0];
    const [read, write] = [sio.readUint32.bind(sio), sio.writeUint32.bind(sio)];
    sio.readUint32 = (offset) => {
      const me = this.selected;
      if (offset === 0x000) return me;
      if (offset === 0x050) {
        const room = this.letters[1 - me].length < FIFO_DEPTH;
        return (this.letters[me].length ? 1 : 0) | (room ? 2 : 0) | this.letterErrors[me];
      }
      if (offset !== 0x058) return read(offset);
      if (!this.letters[me].length) this.letterErrors[me] |= 8;
      return this.letters[me].shift() ?? 0;
    };
    sio.writeUint32 = (offset, value) => {
      const me = this.selected;
      if (offset === DIVISOR || offset === SIGNED_DIVISOR) this.divided[me] += 1;
      if (offset === 0x050) this.letterErrors[me] = 0;
      else if (offset === 0x054) this.post(me, value >>> 0);
      else this.keepLevel(() => write(offset, value));
    };
  }

  /** What may change the pin. A byte may be out by chance: it counts whether that was asked. */
  keepLevel(change) {
    const level = this.level?.();
    change();
    if (level !== this.level?.() && this.isSending) {
      this.wire.fault('D/C changed, and nobody had asked whether the bus is idle');
    }
  }

  post(from, value) {
    if (from === 0 && this.sending && this.isSending) {
      this.wire.fault('a frame ended, and nobody had asked whether the bus is idle');
    }
    if (this.letters[1 - from].length < FIFO_DEPTH) this.letters[1 - from].push(value);
    else this.letterErrors[from] |= 4;
  }

  /** Registers of a core that the package lacks: the MPU's, by which rp2040-hal guards a stack's end,
   * and how it sleeps. */
  guards() {
    const { ppb } = this.mcu;
    const fields = { 0xd10: 'sleep', 0xd94: 'control', 0xd98: 'number', 0xd9c: 'base', 0xda0: 'size' };
    this.mpu = [0, 1].map(() => ({ sleep: 0, control: 0, number: 0, base: 0, size: 0 }));
    const [read, write] = [ppb.readUint32.bind(ppb), ppb.writeUint32.bind(ppb)];
    ppb.readUint32 = (offset) => {
      if (offset === 0xd90) return 8 << 8;
      return fields[offset] ? this.mpu[this.selected][fields[offset]] : read(offset);
    };
    ppb.writeUint32 = (offset, value) => {
      if (fields[offset]) this.mpu[this.selected][fields[offset]] = value >>> 0;
      else write(offset, value);
    };
  }

  isGuarded(i, address) {
    const { control, base, size } = this.mpu[i];
    const start = (base & ~0xff) >>> 0;
    if (!(control & 1) || !(size & 1) || address < start || address >= start + 256) return false;
    return !((size >> 8) & (1 << ((address >> 5) & 7)));
  }

  /** PSM: core 1 is held by a bit, and starts in the boot ROM when let go. */
  powerSwitch() {
    const psm = this.mcu.peripherals[PSM];
    const write = psm.writeUint32.bind(psm);
    psm.writeUint32 = (offset, value) => {
      write(offset, value);
      if (offset !== 4) return;
      const held = Boolean(value & (1 << 16));
      if (this.held && !held) this.startCore1();
      this.held = held;
    };
  }

  startCore1() {
    const core = this.cores[1];
    core.registers.fill(0);
    Object.assign(core, {
      VTOR: 0, waiting: false, eventRegistered: false, PM: false, currentMode: 0, SPSEL: 0, IPSR: 0,
      SP: this.mcu.bootrom[0], PC: this.mcu.bootrom[1] & ~1, cycles: this.now,
    });
    this.letters.forEach((letters) => { letters.length = 0; });
    Object.assign(this.mpu[1], { control: 0, number: 0, base: 0, size: 0 });
    this.held = false;
  }

  /** What a core reads and writes: the flash cache's cost, and what an M0+ would fault on. */
  memory(core, i) {
    const { mcu, cache, wire } = this;
    const at = () => `by core ${i} at ${hex(core.PC)}`;
    for (const [name, size] of [['Uint32', 4], ['Uint16', 2], ['Uint8', 1]]) {
      const [read, write] = [mcu[`read${name}`].bind(mcu), mcu[`write${name}`].bind(mcu)];
      core[`read${name}`] = (signed) => {
        const address = signed >>> 0;
        if (address & (size - 1)) wire.fault(`unaligned read ${at()}`);
        cache.uses?.read(address, core.cycles);
        if (address >>> 24 === 0x10) core.cycles = cache.access(address, core.cycles);
        return read(address);
      };
      core[`write${name}`] = (signed, value) => {
        const address = signed >>> 0;
        if (address & (size - 1)) wire.fault(`unaligned write ${at()}`);
        if (address < FLASH_END) wire.fault(`write to ${hex(address)} ${at()}`);
        if (this.isGuarded(i, address)) wire.fault(`stack overflow ${at()}`);
        if (address < RAM_END && this.isSent(address)) {
          wire.fault(`write into a buffer that is being sent ${at()}`);
        }
        write(address, value);
      };
    }
  }

  isSent(address) {
    const channel = this.sending;
    return channel?.active && address >= channel.readAddr
      && address < channel.readAddr + channel.transCount * channel.dataSize;
  }

  /** DMA: each start is looked at, and polls of its state are counted. */
  transfers() {
    const { dma } = this.mcu;
    for (const channel of dma.channels) {
      const start = channel.start.bind(channel);
      channel.start = () => {
        for (const text of this.faultsOf(channel)) this.wire.fault(text);
        this.sending = channel;
        start();
      };
    }
    const read = dma.readUint32.bind(dma);
    dma.readUint32 = (offset) => {
      const cycles = this.cores[0].cycles;
      if (this.selected === 0 && this.sending?.active) {
        if (cycles - (this.lastPoll ?? -POLL) < POLL) this.polled += cycles - this.lastPoll;
        this.lastPoll = cycles;
      }
      return read(offset);
    };
  }

  faultsOf({ ctrl, readAddr, writeAddr, transCountReload, treqValue, dataSize }) {
    const spi = this.mcu.spi[0];
    const [dcHigh, count] = [this.level(), transCountReload * dataSize];
    const reset = this.mcu.peripherals[RESETS].readUint32(0) & (1 << 2);
    const checks = [
      [writeAddr === SPI0_DATA, `DMA writes to ${hex(writeAddr)}`],
      [dataSize === 1, `DMA is ${8 * dataSize} bits wide`],
      [treqValue === DREQ_SPI0_TX, `DMA has request line ${treqValue}`],
      [ctrl & 0x10 && !(ctrl & 0x20), 'DMA does not step through its buffer'],
      [readAddr >= RAM && readAddr + count <= RAM_END, `DMA reads from ${hex(readAddr)}`],
      [spi.dmaControl & 2, 'SPI does not ask for DMA'],
      [spi.dataBits === 8, `SPI words have ${spi.dataBits} bits`],
      [!reset, 'DMA is held in reset'],
      [dcHigh, 'DMA of pixels with D/C low'],
    ];
    return checks.filter(([holds]) => !holds).map(([, text]) => text);
  }

  /** SPI0: a byte takes 8 clocks, and its last bit tells whether it is a command. `isSending` until
   * somebody has read that the bus is idle. */
  bus({ GPIOPinState }) {
    const spi = this.mcu.spi[0];
    this.level = () => Number(this.mcu.gpio[DC_PIN].value === GPIOPinState.High);
    let [value, level] = [0, 0];
    const arrived = this.mcu.clock.createAlarm(() => {
      if (this.level() !== level) this.wire.fault('D/C changed while a byte was on the bus');
      this.wire.byte(value, this.level(), this.mcu.clock.micros);
      spi.completeTransmit(0);
    });
    const read = spi.readUint32.bind(spi);
    spi.readUint32 = (offset) => {
      const state = read(offset);
      if (offset === SPI_STATE && !(state & SPI_BUSY)) this.isSending = false;
      return state;
    };
    spi.onTransmit = (byte) => {
      this.isSending = true;
      [value, level] = [byte, this.level()];
      const seconds = 8 / spi.clockFrequency;
      this.busCycles += seconds * this.mcu.clkSys;
      arrived.schedule(1e9 * seconds);
    };
  }

  /** Cycles so far, of which the bus was busy, cores waited, and misses. */
  figures() {
    const waited = this.slept[0] + this.slept[1] + this.polled;
    return [this.now, this.busCycles, waited, this.cache.misses];
  }

  select(i) {
    if (this.selected === i) return;
    const { sio } = this.mcu;
    for (const key of Object.keys(this.own[i])) this.own[this.selected][key] = sio[key];
    Object.assign(sio, this.own[i]);
    this.selected = i;
    this.mcu.core = this.cores[i];
  }

  /** The event of one core wakes the other, or is kept for it. */
  wake(from) {
    this.event = false;
    this.cores.forEach((core, i) => {
      if (!core.waiting) {
        core.eventRegistered = true;
        return;
      }
      core.waiting = false;
      const at = Math.max(from.cycles, core.cycles);
      this.slept[i] += at - core.cycles;
      core.cycles = at;
    });
  }

  /** Runs until the wire is over, but at most so many cycles. */
  run(limit) {
    const { mcu, cores: [first, second] } = this;
    while (!this.wire.over) {
      const awake = [!first.waiting, !this.held && !second.waiting];
      let until = this.now;
      if (awake[0] || awake[1]) {
        const i = awake[0] && (!awake[1] || first.cycles <= second.cycles) ? 0 : 1;
        this.step(i);
        until = awake[0] && awake[1] ? Math.min(first.cycles, second.cycles) : this.cores[i].cycles;
      } else {
        const nanos = mcu.clock.nanosToNextAlarm;
        if (!(nanos > 0)) return this.stop('both cores sleep, and nothing is to come');
        until += (nanos * mcu.clkSys) / 1e9;
        this.cores.forEach((core, i) => {
          this.slept[i] += Math.max(0, until - core.cycles);
          core.cycles = Math.max(until, core.cycles);
        });
      }
      if (until > this.now) {
        mcu.clock.tick(((until - this.now) * 1e9) / mcu.clkSys);
        this.now = until;
      }
      if (this.now > limit) this.stop(`nothing more came within ${limit} cycles`);
    }
  }

  step(i) {
    const core = this.cores[i];
    // A core that slept goes on at the time that it is.
    if (core.cycles < this.now && this.cores[1 - i].waiting) core.cycles = this.now;
    this.select(i);
    core.executeInstruction();
    if (core.SP < this.lowest[i] && core.SP > RAM) this.lowest[i] = core.SP;
    if (this.event) this.wake(core);
  }
}

export function hex(value) {
  return (value >>> 0).toString(16).padStart(8, '0');
}
