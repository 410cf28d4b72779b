// Runs an ELF on the RP2040 of rp2040.mjs:
//   node run-rp2040.mjs PACKAGES BOOTROM ELF FRAMES MISS_CYCLES [functions]
import fs from 'node:fs';
import { Board, hex } from './rp2040.mjs';
import { Wire } from './wire.mjs';
import { LineUses } from './xip.mjs';

// Core 0's stack grows down from the end of the striped RAM.
const TOP_OF_STACK = 0x20040000;
const LIMIT_A_FRAME = 60e6;
const LIMIT_OF_START = 200e6;
// What was not read for so many cycles, about a line of the picture, has to come again.
const PERIOD = 20e3;

const [packages, bootrom, elf, frames, missCost, functions] = process.argv.slice(2);
let board;
const uses = functions ? new LineUses(PERIOD) : undefined;
const wire = new Wire(Number(frames), () => {
  uses?.begin();
  return board.figures();
});
board = await Board.load({
  packages, elf, wire, missCost: Number(missCost), bootrom: fs.readFileSync(bootrom),
});
board.cache.uses = uses;
board.run(LIMIT_OF_START + Number(frames) * LIMIT_A_FRAME);
const { mcu } = board;
wire.say(`clock ${mcu.clkSys}`);
wire.say(`bus ${Math.round(mcu.spi[0].clockFrequency)}`);
wire.say(`stack ${TOP_OF_STACK - board.lowest[0]}`);
wire.say(`divisions ${board.divided[0] + board.divided[1]}`);
wire.say(`note lowest stack pointers ${board.lowest.map(hex).join(' and ')}`);
wire.say(`note cores slept ${board.slept.map(Math.round).join(' and ')} cycles`);
for (const text of board.unknowns ?? []) wire.say(`note ${text}`);
for (const [address, { misses, returns }] of uses?.counts ?? []) {
  wire.say(`use ${address} ${misses} ${returns}`);
}
wire.close();
