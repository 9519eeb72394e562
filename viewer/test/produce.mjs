// Has the program write every page and figure that it can, into one folder.
// `node test/produce.mjs FOLDER` does only that, to look at them.

import { execFile } from 'node:child_process';
import { existsSync, readdirSync } from 'node:fs';
import { basename, dirname, join, relative, sep } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

/** The program: what FLEXURE names, else what `cargo build --release` leaves. */
export const PROGRAM = process.env.FLEXURE ?? fileURLToPath(new URL('../../target/release/flexure', import.meta.url));
export const there = existsSync(PROGRAM);

/** Commands, the exit codes that are right for them, and the pages that they write beside their figures. */
export const COMMANDS = [
  { folder: 'reproduce', words: 'reproduce', pages: ['report.html'] },
  { folder: 'panda', words: 'run panda-tanh-smooth --view --page OUT --out OUT', pages: ['panda-tanh-smooth.run.html', 'panda-tanh-smooth.view.html'] },
  { folder: 'ran', words: 'run two-link-tanh --page OUT --out OUT', pages: ['two-link-tanh.run.html'] },
  { folder: 'everything', words: 'run two-link-everything --view', codes: [0, 1], pages: ['two-link-everything.view.html'] },
  { folder: 'pair', words: 'run --view two-link-linear-smooth two-link-tanh-smooth', pages: ['two-link-linear-smooth-and-two-link-tanh-smooth.view.html'] },
  { folder: 'diverging', words: 'run two-link-tanh --set control_period=0.01 --view --page OUT --out OUT', codes: [1], pages: ['two-link-tanh.run.html', 'two-link-tanh.view.html'] },
  { folder: 'margins', words: 'margins pendulum-tanh --page OUT', pages: ['pendulum-tanh.margins.html'] },
  { folder: 'proved', words: 'certify two-link-tanh --page OUT --out OUT/two-link-tanh.certificate.json', pages: ['two-link-tanh.certify.html'] },
  { folder: 'undecided', words: 'certify panda-tanh-smooth --disturbance 0.05 --page OUT --out OUT/panda.certificate.json', codes: [3], pages: ['panda-tanh-smooth.certify.html'] },
  { folder: 'refuted', words: 'certify two-link-tanh --rate 99 --page OUT --out OUT/none.json', codes: [1], pages: ['two-link-tanh.certify.html'] },
  { folder: 'tuned', words: 'tune two-link-hardware --budget 10 --page OUT --out OUT/tuned.toml', pages: ['two-link-hardware.tune.html'] },
  { folder: 'swept', words: 'sweep test/soft-springs.toml --page OUT --out OUT/rows', pages: ['soft-springs.sweep.html'] },
  { folder: 'identified', words: 'identify quanser-2dof --log ALL/reproduce/two-link-tanh-smooth.csv --page OUT', after: 'reproduce', codes: [0, 1], pages: ['quanser-2dof.identify.html'] },
  { folder: 'compare', words: 'compare task-ideal-tracking task-soft task-payload --budget 1 --seeds 1', pages: ['compare.html'] },
];

/** The words of a command with its folder for OUT, which goes behind `--out` where it is not said, and the one that all folders are in for ALL. */
function said(words, out) {
  const whole = words.split(' ').map(word => word.replace('OUT', out).replace('ALL', dirname(out)));
  return words.includes('OUT') ? whole : [...whole, '--out', out];
}

function run(words, out) {
  return new Promise(resolve => {
    execFile(PROGRAM, said(words, out), { cwd: fileURLToPath(new URL('..', import.meta.url)), timeout: 120_000, maxBuffer: 2 ** 26 }, (error, _, said) => resolve({ code: error ? error.code ?? error.signal : 0, said }));
  });
}

/** Runs the commands, two at a time; each with its exit code and what it said on standard error. */
export async function produce(folder) {
  const done = [];
  const work = async left => {
    for (let next = left.shift(); next; next = left.shift()) done.push({ codes: [0], ...next, ...await run(next.words, join(folder, next.folder)) });
  };
  const first = COMMANDS.filter(({ after }) => !after), then = COMMANDS.filter(({ after }) => after);
  await Promise.all([work(first), work(first)]);
  await work(then);
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
