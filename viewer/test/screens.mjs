// Screenshots, compared coarsely: as a grid of luminances, which fonts that are hinted otherwise hardly change and a missing figure does.
// `SCREENS=write npm test` keeps how pages look now; look at them first.

import { existsSync, readFileSync, writeFileSync } from 'node:fs';

const FILE = new URL('screens.json', import.meta.url), COLUMNS = 48, ROWS = 27;
/** Words reflow and edges are smoothed otherwise: so many cells of a hundred may differ by more than so much of 255, and all on average by no more than that. */
const CELLS = 5, STEP = 40, MEAN = 5;

const kept = existsSync(FILE) ? JSON.parse(readFileSync(FILE, 'utf8')) : {}, written = {};
export const writing = process.env.SCREENS === 'write';

/** The grid of what a page shows: the mean luminance of each cell, row by row. */
export async function grid(page) {
  const png = (await page.screenshot()).toString('base64');
  const blank = await page.context().newPage();
  try {
    return await blank.evaluate(async ([png, columns, rows]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${png}`;
      await image.decode();
      const canvas = document.createElement('canvas'), { width, height } = image;
      Object.assign(canvas, { width, height });
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, width, height), sums = new Float64Array(columns * rows), counts = new Float64Array(columns * rows);
      for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
          const cell = Math.floor(y * rows / height) * columns + Math.floor(x * columns / width), at = 4 * (y * width + x);
          sums[cell] += 0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2];
          counts[cell] += 1;
        }
      }
      return Array.from(sums, (sum, cell) => Math.round(sum / counts[cell]));
    }, [png, COLUMNS, ROWS]);
  } finally { await blank.close(); }
}

/** What is different from how `name` looked when it was kept, in sentences. */
export function unlike(name, cells) {
  if (writing) {
    written[name] = Buffer.from(cells).toString('base64');
    return [];
  }
  if (!kept[name]) return [`how ${name} looks is not kept: look at it, then SCREENS=write npm test`];
  const before = Buffer.from(kept[name], 'base64'), differences = cells.map((cell, at) => Math.abs(cell - before[at]));
  const far = differences.filter(difference => difference > STEP).length / cells.length * 100, mean = differences.reduce((sum, difference) => sum + difference, 0) / cells.length;
  if (far <= CELLS && mean <= MEAN) return [];
  const worst = differences.indexOf(Math.max(...differences)), [column, row] = [worst % COLUMNS, Math.floor(worst / COLUMNS)];
  return [`${name} looks otherwise: ${far.toFixed(1)} % of the cells by more than ${STEP} of 255 (${CELLS} % may), ${mean.toFixed(1)} on average (${MEAN} may); the worst is cell ${column} of ${COLUMNS} from the left and ${row} of ${ROWS} from above`];
}

/** Keeps what was seen. */
export function keep() {
  if (writing) writeFileSync(FILE, `${JSON.stringify(Object.fromEntries(Object.entries(written).sort()), null, 1)}\n`);
}
