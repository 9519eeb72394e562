// Opens every page and every figure that the program writes in a browser without a window, and looks at what a reader would see.

import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { after, before, describe, test } from 'node:test';
import { chromium } from 'playwright-core';
import { look } from './look.mjs';
import { grid, keep, unlike, writing } from './screens.mjs';
import { COMMANDS, files, produce, runsOf, there as built } from './produce.mjs';

const CHROMIUM = '/usr/bin/chromium', browsed = existsSync(CHROMIUM), there = browsed && built;
if (!browsed) console.log(`The tests of the pages are skipped: there is no ${CHROMIUM}. On Debian, \`apt-get install chromium\` brings it.`);
if (!built) console.log('The tests of the pages are skipped: the program is not there. `cargo build --release` makes it; FLEXURE names another.');

const WIDE = { width: 1440, height: 900 }, PHONE = { width: 390, height: 844 };
/** A sheet of A4, in pixels of CSS. */
const SHEET = { width: 794, height: 1123 };
/** The smallest words of a figure that are still read, in pixels: on a screen, and on paper, where 6.5 px are 4.9 pt. */
const SMALLEST = { screen: 8, paper: 6.5 };
const SCREENS = ['light', 'dark'].flatMap(colorScheme => [['wide', WIDE], ['phone', PHONE]].map(([size, viewport]) => ({ words: `${size}, ${colorScheme}`, viewport, colorScheme })));

const folder = there ? mkdtempSync(join(tmpdir(), 'flexure-pages-')) : null;
const done = there ? await produce(folder) : [];
const pages = there ? files(folder, '.html') : [], figures = there ? files(folder, '.svg') : [];

let browser;
before(async () => { if (there) browser = await chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] }); });
after(async () => {
  await browser?.close();
  keep();
  if (folder) rmSync(folder, { recursive: true });
});

/** Nothing wrong; else every sentence on a line of its own. */
function clean(file, found) {
  assert.ok(found.length === 0, `${file}: ${found.length} thing${found.length === 1 ? '' : 's'} wrong\n  ${found.slice(0, 40).join('\n  ')}`);
}

/** Waits until a page is drawn as it now is. */
const settle = page => page.evaluate(() => new Promise(resolve => { requestAnimationFrame(() => requestAnimationFrame(resolve)); }));

/** As on paper: the page is as wide as its margins leave it. */
async function print(page) {
  const margin = await page.evaluate(() => window.look.margin());
  await page.setViewportSize({ width: Math.floor(SHEET.width - 2 * margin), height: Math.floor(SHEET.height - 2 * margin) });
  await page.emulateMedia({ media: 'print' });
  await settle(page);
}

/** Opens a file; `wrong` gathers messages of errors and requests of anything else. */
async function open(path, { viewport = WIDE, colorScheme = 'light' } = {}) {
  const url = pathToFileURL(path).href, context = await browser.newContext({ viewport, colorScheme }), page = await context.newPage(), wrong = [];
  await context.addInitScript(look);
  page.on('console', message => { if (message.type() === 'error') wrong.push(`the console says “${message.text()}”`); });
  page.on('pageerror', error => wrong.push(`an error: ${error.message}`));
  page.on('request', request => { if (request.url().split('#')[0] !== url && !/^(blob:|data:|about:srcdoc)/.test(request.url())) wrong.push(`a request of ${request.url()}`); });
  // Motion stands still: to draw it takes longer than all else.
  await page.goto(path.endsWith('.view.html') ? `${url}#t=1&play=0` : url);
  await settle(page);
  return { page, wrong, close: () => context.close() };
}

const ask = (page, what, ...rest) => page.evaluate(([key, values]) => window.look[key](...values), [what, rest]);
const askFigure = (page, what) => page.evaluate(key => window.look[key](document.querySelector('svg')), what);

/** The page within a page, once it runs. */
async function motion(page) {
  await page.locator('iframe.motion').scrollIntoViewIfNeeded();
  const frame = await (await page.waitForSelector('iframe.motion')).contentFrame();
  await frame.waitForFunction(() => window.flexure?.state().runs.length);
  return frame;
}

describe('the program', { skip: !there }, () => {
  for (const { words, folder: own, codes = [0], pages: expected } of COMMANDS) {
    test(`writes what it says: ${words}`, () => {
      const { code, said } = done.find(one => one.folder === own);
      assert.ok(codes.includes(code), `flexure ${words}: exit code ${code}\n${said}`);
      for (const page of expected) assert.ok(pages.includes(`${own}/${page}`), `flexure ${words} wrote no ${page}, but ${pages.filter(path => path.startsWith(own)).join(', ') || 'no page'}`);
    });
  }

  test('writes figures beside its pages', () => {
    for (const own of ['reproduce', 'margins', 'compare']) assert.ok(figures.some(path => path.startsWith(`${own}/`)), `no figure in ${own}`);
  });
});

describe('the pages', { skip: !there, concurrency: 2 }, () => {
  for (const file of pages) {
    const path = join(folder ?? '', file);

    for (const { words, ...screen } of SCREENS) {
      describe(`${file}, ${words}`, { concurrency: 1 }, () => {
        let opened;
        before(async () => { opened = await open(path, screen); });
        after(() => opened.close());

        // On a phone a word more moves all that is below it.
        if (screen.viewport === WIDE) test('looks as it did', async () => clean(file, unlike(`${file}, ${words}`, await grid(opened.page))));

        test('says what came of it, in a number, right after the heading', async () => clean(file, await ask(opened.page, 'unsaid')));

        test('does not scroll sideways as it opens', async () => clean(file, await ask(opened.page, 'sideways')));

        test('opens its details by a click', async () => {
          for (const summary of await opened.page.locator('summary').all()) await summary.click();
          clean(file, await ask(opened.page, 'folded'));
        });

        test('does not scroll sideways with its details open', async () => {
          await ask(opened.page, 'openAll');
          clean(file, await ask(opened.page, 'sideways'));
        });

        test('has no text that is too faint', async () => {
          await ask(opened.page, 'openAll');
          clean(file, await ask(opened.page, 'faint'));
        });

        test('keeps its words apart', async () => {
          await ask(opened.page, 'openAll');
          clean(file, await ask(opened.page, 'collisions'));
        });

        test('shows its words whole', async () => {
          await ask(opened.page, 'openAll');
          clean(file, [...await ask(opened.page, 'shortened'), ...await ask(opened.page, 'chopped')]);
        });

        test('has figures that can be read', async () => {
          await ask(opened.page, 'openAll');
          clean(file, await ask(opened.page, 'small', SMALLEST.screen));
        });

        test('has words in its headings', async () => clean(file, await ask(opened.page, 'nameless')));

        test('shows no word of a program', async () => {
          await ask(opened.page, 'openAll');
          clean(file, await ask(opened.page, 'leaks'));
        });

        test('leads somewhere with its links', async () => clean(file, await ask(opened.page, 'lost')));

        test('shows the runs of its motion', async () => {
          if (file.endsWith('.view.html')) assert.deepEqual(await opened.page.evaluate(() => window.flexure.state().runs), runsOf(file));
          if (!await opened.page.locator('iframe.motion').count()) return;
          const frame = await motion(opened.page), { runs } = await frame.evaluate(() => window.flexure.state());
          const listed = await opened.page.locator('#summary tbody th a').allTextContents();
          for (const run of runs) assert.ok(listed.includes(run), `${file}: the motion shows ${run}; the table of runs has ${listed.join(', ')}`);
          const found = [];
          for (const what of ['faint', 'leaks', 'sideways', 'collisions', 'shortened', 'chopped']) found.push(...await ask(frame, what));
          clean(`${file}, iframe.motion`, found);
        });

        if (file.endsWith('.view.html')) {
          test('says at its end that it diverged, if it did', async () => {
            const diverged = await opened.page.evaluate(() => JSON.parse(document.getElementById('flexure-runs').textContent).runs.some(run => run.events.some(event => event.kind === 'diverged')));
            await opened.page.keyboard.press('End');
            await settle(opened.page);
            const badges = await opened.page.locator('.badges').allInnerTexts(), { t } = await opened.page.evaluate(() => window.flexure.state());
            assert.equal(/Diverged/.test(badges.join(' ')), diverged, `${file}: at ${t} s, its end, the badges are “${badges.join(' ')}”`);
          });
        }

        test('has no errors and asks for no other file', () => clean(file, opened.wrong));
      });
    }

    describe(`${file}, on paper`, { concurrency: 1 }, () => {
      let opened;
      before(async () => {
        opened = await open(path);
        await print(opened.page);
      });
      after(() => opened.close());

      test('has its details open', async () => clean(file, await ask(opened.page, 'folded')));

      test('cuts nothing at the right', async () => clean(file, await ask(opened.page, 'cut')));

      test('has something under each heading', async () => clean(file, await ask(opened.page, 'bare')));

      test('keeps its words apart', async () => clean(file, await ask(opened.page, 'collisions')));

      test('has figures that can be read', async () => clean(file, await ask(opened.page, 'small', SMALLEST.paper)));

      test('has no text that is too faint', async () => clean(file, await ask(opened.page, 'faint')));
    });
  }
});

describe('the figures', { skip: !there, concurrency: 2 }, () => {
  for (const file of figures) {
    const path = join(folder ?? '', file);

    for (const colorScheme of ['light', 'dark']) {
      describe(`${file}, ${colorScheme}`, { concurrency: 1 }, () => {
        let opened;
        before(async () => { opened = await open(path, { colorScheme }); });
        after(() => opened.close());

        test('is an SVG', async () => {
          const root = await opened.page.evaluate(() => ({ name: document.documentElement.nodeName, error: document.querySelector('parsererror')?.textContent ?? '', texts: document.querySelectorAll('text').length }));
          assert.equal(root.error, '', file);
          assert.equal(root.name, 'svg', file);
          assert.ok(root.texts > 0, `${file} has no text`);
        });

        test('keeps its texts apart', async () => clean(file, await askFigure(opened.page, 'overlaps')));

        test('keeps its texts inside', async () => clean(file, await askFigure(opened.page, 'outside')));

        test('has words at its axes and in its legends', async () => clean(file, await askFigure(opened.page, 'wordless')));

        test('has numbers where they are due', async () => clean(file, await askFigure(opened.page, 'unlike')));

        test('has no text that is too faint', async () => clean(file, await ask(opened.page, 'faint')));

        test('is as dark as its reader wants it', async () => {
          const ground = await askFigure(opened.page, 'ground'), light = await opened.page.evaluate(css => window.look.darkness(css), ground);
          assert.ok(colorScheme === 'dark' ? light < 0.05 : light > 0.8, `${file}: the ground is ${ground}`);
        });

        test('has no errors and asks for no other file', () => clean(file, opened.wrong));
      });
    }
  }
});

// A check that finds nothing may look at nothing: each of these breaks a copy of a page or a figure in one place.
describe('the checks', { skip: !there, concurrency: false }, () => {
  const page = 'margins/pendulum-tanh.margins.html', figure = figures.find(path => path.startsWith('margins/'));

  async function broken(file, change, screen, find) {
    const copy = join(folder, `broken.${file.split('.').pop()}`), text = readFileSync(join(folder, file), 'utf8'), changed = change(text);
    assert.notEqual(changed, text, `nothing was broken in ${file}`);
    writeFileSync(copy, changed);
    const opened = await open(copy, screen);
    try { return await find(opened); } finally { await opened.close(); }
  }

  const one = (found, what) => assert.ok(found.some(sentence => what.test(sentence)), `${what} is not among\n  ${found.join('\n  ') || 'no sentences'}`);
  const style = rule => text => text.replace('</head>', `<style>${rule}</style></head>`);

  for (const [words, change, what, expected] of [
    ['faint text', style('.note { color: #999; background: #fff }'), 'faint', /\.note.*contrast of 2\.85, #999999 on #ffffff/],
    ['faint text behind a veil', style('.note { opacity: .3 }'), 'faint', /\.note.*contrast of/],
    ['a verdict without a number', text => text.replace(/(<p class="verdict[^>]*>)[^]*?<\/p>/, '$1All is well.</p>'), 'unsaid', /has no number: “All is well\.”/],
    ['a verdict that comes late', text => text.replace('<p class="verdict', '<p>First this.</p><p class="verdict'), 'unsaid', /comes header p, no \.verdict/],
    ['a page that is too wide', text => text.replace('</main>', '<div style="width: 2000px">wide</div></main>'), 'sideways', /div “wide” ends at/],
    ['an empty heading', text => text.replace('</main>', '<h2> </h2></main>'), 'nameless', /h2 is empty/],
    ['a word of a program', text => text.replace('</main>', '<p>error NaN mrad</p></main>'), 'leaks', /has the text NaN/],
    ['a backtick', text => text.replace('</main>', '<p>see `run`</p></main>'), 'leaks', /has the text `/],
    ['details without contents', text => text.replace('</main>', '<details open><summary>Nothing</summary></details></main>'), 'folded', /“Nothing” are not seen/],
    ['words on each other', text => text.replace('</main>', '<p style="height: 0; margin: 0">first words</p><p style="margin: 0">second words</p></main>'), 'collisions', /“first words” and “second words” lie on each other/],
    ['words under a button', text => text.replace('</main>', '<p style="margin: 0">some words<button style="margin-left: -30px">on them</button></p></main>'), 'collisions', /“some words” and button lie on each other/],
    ['shortened words', text => text.replace('</main>', '<p style="width: 40px; overflow: hidden; white-space: nowrap; text-overflow: ellipsis">a long name</p></main>'), 'shortened', /“a long name” \(p\) shows 40 px of \d+ px/],
    ['words that leave a chart', text => text.replace('</main>', '<canvas width="50" height="50"></canvas><script>document.querySelector("canvas").getContext("2d").fillText("100000000", -20, 20)</script></main>'), 'chopped', /“100000000” is drawn from -20 px/],
    ['a figure that is too small', style('.card svg { width: 300px; min-width: 0 }'), 'small', /smallest words are \d\.\d px high and need 8/],
    ['a heading with nothing under it', text => text.replace('</main>', '<section id="none"><h2>Alone</h2></section></main>'), 'bare', /nothing stands under “Alone” \(#none\)/],
    ['a link to nowhere', text => text.replace('</main>', '<a href="#gone">gone</a></main>'), 'lost', /“gone” leads to #gone/],
  ]) {
    test(`find ${words}`, async () => one(await broken(page, change, {}, opened => ask(opened.page, what, ...(what === 'small' ? [SMALLEST.screen] : []))), expected));
  }

  test('find a page that looks otherwise', { skip: writing }, async () => {
    const see = change => broken(page, change, {}, async opened => unlike(`${page}, wide, light`, await grid(opened.page)));
    one(await see(style('.card svg { visibility: hidden }')), /looks otherwise/);
    one(await see(style('body { background: #000 }')), /looks otherwise/);
    assert.deepEqual(await see(style('p.verdict { letter-spacing: .1px }')), []);
  });

  test('find a request', async () => one(await broken(page, text => text.replace('</main>', '<img alt="" src="http://127.0.0.1:9/there.png"></main>'), {}, ({ wrong }) => wrong), /a request of http:\/\/127\.0\.0\.1:9\/there\.png/));

  test('find an error', async () => one(await broken(page, text => text.replace('</main>', '<script>throw new Error("broken")</script></main>'), {}, ({ wrong }) => wrong), /an error: broken/));

  test('find what paper cuts', async () => one(await broken(page, style('@media print { table { width: 900px !important } }'), {}, async opened => {
    await print(opened.page);
    return ask(opened.page, 'cut');
  }), /table .* of a page of \d+ px/));

  test('find details that stay closed on paper', async () => one(await broken(page, style('@media print { details::details-content { content-visibility: hidden !important } }'), {}, async opened => {
    await print(opened.page);
    return ask(opened.page, 'folded');
  }), /are not seen/));

  const added = extra => text => text.replace('</svg>', `${extra}</svg>`);
  for (const [words, change, what, expected] of [
    ['texts on each other', added('<text x="40" y="40" font-size="20">one</text><text x="44" y="44" font-size="20">two</text>'), 'overlaps', /“one” and “two” lie on each other/],
    ['texts on each other, one of them turned', added('<text x="300" y="200" font-size="20">a long line</text><text x="340" y="230" font-size="20" transform="rotate(-90 340 230)">upwards</text>'), 'overlaps', /“a long line” and “upwards” lie on each other/],
    ['a text that leaves', added('<text x="-20" y="40" font-size="20">gone</text>'), 'outside', /“gone” leaves the figure at the left by/],
    ['an empty label', added('<text x="40" y="40"> </text>'), 'wordless', /the text at 40, 40 is empty/],
    ['a number that is none', added('<path d="M0 0L10 NaN" fill="none"/>'), 'unlike', /d of path is “M0 0L10 NaN”/],
  ]) {
    test(`find ${words}`, async () => one(await broken(figure, change, {}, opened => askFigure(opened.page, what)), expected));
  }

  test('find faint text on a shape', async () => one(await broken(figure, added('<path d="M10 10L400 10L400 60L10 60Z" fill="#0072b2"/><text x="40" y="40" font-size="14" fill="#1f2328">dark on blue</text>'), {}, opened => ask(opened.page, 'faint')), /“dark on blue”.*#1f2328 on #0072b2/));

  test('find a figure that stays light', async () => {
    const ground = await broken(figure, text => text.replace(/prefers-color-scheme:dark/g, 'prefers-color-scheme:none'), { colorScheme: 'dark' }, opened => askFigure(opened.page, 'ground'));
    assert.equal(ground, '#ffffff');
  });

  test('find a figure that is not well formed', async () => {
    const error = await broken(figure, text => text.replace('</svg>', '<g></svg>'), {}, opened => opened.page.evaluate(() => document.querySelector('parsererror')?.textContent));
    assert.match(error ?? '', /error on line \d+ at column \d+/);
  });
});
