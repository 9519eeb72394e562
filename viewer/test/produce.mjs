// Has the program write every page and figure that it can, into one folder.
// `node test/produce.mjs FOLDER` does only that, to look at them.

import { execFile } from 'node:child_process';
import { existsSync, readdirSync } from 'node:fs';
import { basename, join, relative, sep } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

/** The program: what FLEXURE names, else what `cargo build --release` leaves. */
export const PROGRAM = process.env.FLEXURE ?? fileURLToPath(new URL('../../target/release/flexure', import.meta.url));
export const there = existsSync(PROGRAM);

/** Commands, the exit codes that are right for them, and the pages that they write beside their figures. */
export const COMMANDS = [
  { folder: 'reproduce', words: 'reproduce', pages: ['report.html'] },
  { folder: 'panda', words: 'run panda-tanh-smooth --view', pages: ['panda-tanh-smooth.view.html'] },
  { folder: 'everything', words: 'run two-link-everything --view', codes: [0, 1], pages: ['two-link-everything.view.html'] },
  { folder: 'pair', words: 'run --view two-link-linear-smooth two-link-tanh-smooth', pages: ['two-link-linear-smooth-and-two-link-tanh-smooth.view.html'] },
  { folder: 'diverging', words: 'run two-link-tanh --set control_period=0.01 --view', codes: [1], pages: ['two-link-tanh.view.html'] },
  { folder: 'margins', words: 'margins pendulum-tanh', pages: ['pendulum-tanh.margins.html'] },
  { folder: 'compare', words: 'compare task-ideal-tracking task-soft task-payload --budget 1 --seeds 1', pages: ['compare.html'] },
];

function run(words, out) {
  return new Promise(resolve => {
    execFile(PROGRAM, [...words.split(' '), '--out', out], { timeout: 120_000, maxBuffer: 2 ** 26 }, (error, _, said) => resolve({ code: error ? error.code ?? error.signal : 0, said }));
  });
}

/** Runs the commands, two at a time; each with its exit code and what it said on standard error. */
export async function produce(folder) {
  const left = [...COMMANDS], done = [];
  const work = async () => {
    for (let next = left.shift(); next; next = left.shift()) done.push({ codes: [0], ...next, ...await run(next.words, join(folder, next.folder)) });
  };
  await Promise.all([work(), work()]);
  return done;
}

/** Files in `folder` and below whose names end in `ending`, as paths from there with slashes, in their order. */
export function files(folder, ending) {
  const names = readdirSync(folder, { recursive: true }).filter(name => name.endsWith(ending));
  return names.map(name => relative(folder, join(folder, name)).split(sep).join('/')).sort();
}

/** Names of the runs on a page of motion, which its file name has. */
export const runsOf = page => basename(page, '.view.html').split('-and-');

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const done = await produce(process.argv[2]);
  for (const { words, code } of done) console.log(`flexure ${words}: exit code ${code}`);
}
