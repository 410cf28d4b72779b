// The RP2040's cache model, and a transfer as it should be and with one thing wrong each.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { Board } from './rp2040.mjs';
import { FlashCache, LineUses } from './xip.mjs';

const packages = process.env.SCANBEAM_PACKAGES ?? '.';
const isHere = fs.existsSync(path.join(packages, 'node_modules/rp2040js'));
const [RESETS, SPI, DMA, SIO, IO] = [0x4000c000, 0x4003c000, 0x50000000, 0xd0000000, 0x40014000];
const DC = 1 << 4;
const SPI0_TX = 16;

test('a line of the cache is missed once, and the older of two ways is replaced', () => {
  const cache = new FlashCache(56);
  assert.equal(cache.access(0x10000000, 100), 156);
  assert.equal(cache.access(0x10000007, 200), 200);
  assert.equal(cache.access(0x10000008, 210), 266);
  const sameSet = [0x10002000, 0x10000000, 0x10004000]; // 8 KB apart; the first line stays
  sameSet.forEach((address) => cache.access(address, 1000));
  assert.equal(cache.misses, 4);
  cache.access(0x10000000, 2000);
  assert.equal(cache.misses, 4);
  cache.access(0x10002000, 2000);
  assert.equal(cache.misses, 5);
});

test('the flash serves one miss after the other', () => {
  const cache = new FlashCache(56);
  cache.access(0x10000000, 100);
  assert.equal(cache.access(0x10000100, 110), 212);
});

test('a line is wanted once a period, by who asks first, and counted from the first frame on', () => {
  const uses = new LineUses(1000);
  const cache = Object.assign(new FlashCache(56), { uses });
  const ask = (address, cycle) => {
    uses.read(address, cycle);
    cache.access(address, cycle);
  };
  ask(0x10000000, 100);
  assert.equal(uses.counts.size, 0);
  uses.begin();
  ask(0x10000004, 1100); // is there, and wanted
  ask(0x10000000, 1200);
  uses.read(0x20000010, 1999); // from RAM: wanted, and no miss
  uses.read(0x20000016, 2000);
  ask(0x10000000, 2500);
  ask(0x10000100, 2600);
  ask(0x10000100, 2400); // by the core that is behind
  const counts = Object.fromEntries(uses.counts);
  assert.deepEqual(counts, {
    [0x10000004]: { misses: 0, returns: 1 },
    [0x20000010]: { misses: 0, returns: 1 },
    [0x20000016]: { misses: 0, returns: 1 },
    [0x10000000]: { misses: 0, returns: 1 },
    [0x10000100]: { misses: 1, returns: 1 },
  });
});

/** A board without a program, and the faults that it says. */
async function board() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'scanbeam-'));
  const elf = path.join(folder, 'elf');
  const header = Buffer.alloc(52);
  header.set([0x7f, 0x45, 0x4c, 0x46, 1]);
  fs.writeFileSync(elf, header);
  const faults = [];
  const wire = { fault: (text) => faults.push(text), byte() {}, end() {} };
  const made = await Board.load({ packages, elf, bootrom: Buffer.alloc(16384), missCost: 0, wire });
  fs.rmSync(folder, { recursive: true });
  return { made, faults, set: (address, value) => made.mcu.writeUint32(address, value) };
}

const GOOD = {
  resets: 0, pin: DC, ask: 2, from: 0x20000000, to: SPI + 8, count: 64,
  control: (SPI0_TX << 15) | (1 << 4) | 1,
};

async function faultsOf(change) {
  const { faults, set } = await board();
  const { resets, pin, ask, from, to, count, control } = { ...GOOD, ...change };
  set(RESETS, resets);
  set(IO + 8 * 4 + 4, 5); // GP4 is SIO's
  set(SIO + 0x24, DC);
  set(SIO + 0x14, pin);
  set(SPI, 7);
  set(SPI + 0x10, 2);
  set(SPI + 4, 2);
  set(SPI + 0x24, ask);
  [from, to, count, control].forEach((value, i) => set(DMA + 4 * i, value));
  return faults;
}

test('a transfer as it should be', { skip: !isHere }, async () => {
  assert.deepEqual(await faultsOf({}), []);
});

test('a transfer with one thing wrong', { skip: !isHere }, async () => {
  const { control } = GOOD;
  for (const [change, fault] of [
    [{ resets: 4 }, 'DMA is held in reset'],
    [{ pin: 0 }, 'DMA of pixels with D/C low'],
    [{ ask: 0 }, 'SPI does not ask for DMA'],
    [{ from: 0x10000000 }, 'DMA reads from 10000000'],
    [{ to: 0x20000000 }, 'DMA writes to 20000000'],
    [{ control: control ^ (1 << 15) }, 'DMA has request line 17'],
    [{ control: control ^ (1 << 2) }, 'DMA is 16 bits wide'],
    [{ control: control ^ (1 << 4) }, 'DMA does not step through its buffer'],
    [{ control: control ^ (1 << 5) }, 'DMA does not step through its buffer'],
  ]) {
    assert.deepEqual(await faultsOf(change), [fault]);
  }
});

test('the pin may not change while a byte is on the bus', { skip: !isHere }, async () => {
  const unasked = 'D/C changed, and nobody had asked whether the bus is idle';
  for (const [waits, asks, wanted] of [
    [false, false, [unasked, 'D/C changed while a byte was on the bus']],
    [false, true, [unasked, 'D/C changed while a byte was on the bus']],
    [true, false, [unasked]],
    [true, true, []],
  ]) {
    const { made, faults, set } = await board();
    set(IO + 8 * 4 + 4, 5);
    set(SIO + 0x24, DC);
    set(SPI, 7);
    set(SPI + 0x10, 2);
    set(SPI + 8, 0x2c);
    if (waits) made.mcu.clock.tick(1000);
    if (asks) made.mcu.readUint32(SPI + 0xc);
    set(SIO + 0x14, DC);
    made.mcu.clock.tick(1000);
    assert.deepEqual(faults, wanted);
  }
});

test('a frame ends when the bus is idle', { skip: !isHere }, async () => {
  const { made, faults, set } = await board();
  set(SPI, 7);
  set(SPI + 0x10, 2);
  made.sending = {};
  set(SPI + 8, 0);
  set(SIO + 0x54, 0); // the mailbox: core 1 may go on
  assert.deepEqual(faults, ['a frame ended, and nobody had asked whether the bus is idle']);
});

test('no core may write what is being sent, below its stack, or to odd places', { skip: !isHere }, async () => {
  const { made, faults, set } = await board();
  set(DMA, 0x20000000);
  const [core] = made.cores;
  made.sending = { active: true, readAddr: 0x20000100, transCount: 16, dataSize: 1 };
  core.writeUint32(0x20000110, 0);
  core.writeUint32(0x20000040, 0);
  assert.deepEqual(faults, []);
  core.writeUint8(0x2000010f, 0);
  Object.assign(made.mpu[0], { control: 1, base: 0x20000000, size: 1 });
  core.writeUint32(0x20000040, 0);
  core.writeUint32(0x20000802, 0);
  core.writeUint32(0x10000000, 0);
  const kinds = faults.map((text) => text.split(' by ')[0]);
  assert.deepEqual(kinds.slice(0, 3), [
    'write into a buffer that is being sent', 'stack overflow', 'unaligned write',
  ]);
  assert.ok(kinds.includes('write to 10000000'));
});
