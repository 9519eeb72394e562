// Opens the page in a browser without a window and looks at what a reader would see.

import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { after, before, describe, test } from 'node:test';
import { chromium } from 'playwright-core';
import { page as build } from '../build.mjs';
import { elbow, fill, json, LINKS, SAMPLES } from './sample.mjs';

const CHROMIUM = '/usr/bin/chromium', there = existsSync(CHROMIUM);
if (!there) console.log(`The tests of the page are skipped: there is no ${CHROMIUM}. On Debian, \`apt-get install chromium\` brings it.`);

const WIDE = { width: 1600, height: 900 }, PHONE = { width: 390, height: 844 };

describe('the view page', { skip: !there, concurrency: false }, () => {
  let browser, empty, folder;
  before(async () => {
    empty = await build();
    folder = mkdtempSync(join(tmpdir(), 'flexure-view-'));
    browser = await chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
  });
  after(async () => {
    await browser?.close();
    if (folder) rmSync(folder, { recursive: true });
  });

  /** Opens a sample, runs `look`, and fails on any message of an error and on any request but the file itself. */
  async function open(what, { hash = 't=1.23&play=0', viewport = WIDE, colorScheme = 'light', prepare } = {}, look) {
    const file = join(folder, 'view.html'), url = pathToFileURL(file).href;
    writeFileSync(file, typeof what === 'string' ? what : fill(empty, json(what)));
    const context = await browser.newContext({ viewport, colorScheme }), page = await context.newPage(), wrong = [];
    page.on('console', message => { if (message.type() === 'error') wrong.push(message.text()); });
    page.on('pageerror', error => wrong.push(error.message));
    page.on('request', request => { if (!request.url().startsWith(url) && !request.url().startsWith('data:')) wrong.push(`request of ${request.url()}`); });
    if (prepare) await page.addInitScript(prepare);
    await page.goto(`${url}#${hash}`);
    await page.waitForTimeout(400);
    const state = () => page.evaluate(() => window.flexure.state());
    await look({ page, state });
    await context.close();
    assert.deepEqual(wrong, []);
  }

  const close = (a, b, by, what) => assert.ok(Math.abs(a - b) < by, `${what}: ${a} is not ${b}`);

  test('is small and has one place for the runs', () => {
    assert.ok(Buffer.byteLength(empty) < 1.5e6);
    assert.equal(empty.split('<script type="application/json" id="flexure-runs">null</script>').length, 2);
    assert.equal(empty.split('Permission is hereby granted').length, 3, 'the notices of both libraries');
  });

  test('shows the time of the address, the tip where trigonometry puts it', () => open(SAMPLES['two-link'], {}, async ({ page, state }) => {
    const s = await state(), a = elbow(0, 1.23) + 2e-4 * Math.sin(3.69), b = a + elbow(1, 1.23) + 2e-4 * Math.sin(3.69), [x, y, z] = s.poses[0][0];
    assert.equal(s.t, 1.23);
    assert.equal(s.playing, false);
    assert.deepEqual(s.runs, ['two-link-push']);
    assert.deepEqual(s.joints, ['shoulder', 'elbow']);
    close(x, LINKS[0] * Math.cos(a) + LINKS[1] * Math.cos(b), 1e-5, 'x');
    close(y, 0, 1e-9, 'y');
    close(z, LINKS[0] * Math.sin(a) + LINKS[1] * Math.sin(b), 1e-5, 'z');
    assert.equal(s.magnification, 5);
    await page.selectOption('#magnify', '1');
    assert.equal((await state()).magnification, 1);
    assert.match(await page.textContent('#ghost'), /motor side, deflection/);
    assert.match(await page.textContent('#runs'), /✓ good.*rms link error 1\.9 mrad/);
  }));

  test('obeys the keys, the bar and the address', () => open(SAMPLES['two-link'], {}, async ({ page, state }) => {
    await page.keyboard.press('ArrowRight');
    close((await state()).t, 1.27, 1e-6, 'one step');
    await page.keyboard.press('Shift+ArrowLeft');
    close((await state()).t, 0.87, 1e-6, 'ten steps back');
    await page.keyboard.press('End');
    assert.equal((await state()).t, 8);
    await page.keyboard.press('Home');
    await page.keyboard.press(' ');
    await page.waitForTimeout(700);
    const running = await state();
    assert.ok(running.playing && running.t > 0.05);
    await page.keyboard.press(' ');
    assert.equal((await state()).playing, false);
    await page.evaluate(() => { location.hash = 't=6.5&play=0'; });
    await page.waitForTimeout(100);
    assert.equal((await state()).t, 6.5);
    // A button in focus must not take the space key for itself.
    await page.focus('#play');
    await page.keyboard.press(' ');
    assert.equal((await state()).playing, true);
  }));

  test('seeks by a click on a chart, zooms with shift, hides a joint by its name', () => open(SAMPLES['two-link'], {}, async ({ page, state }) => {
    const box = await page.locator('.u-over').nth(1).boundingBox(), y = box.y + box.height / 2;
    await page.mouse.click(box.x + box.width / 4, y);
    close((await state()).t, 2, 0.02, 'a quarter of the run');
    await page.keyboard.down('Shift');
    await page.mouse.move(box.x + box.width / 2, y);
    await page.mouse.down();
    await page.mouse.move(box.x + 3 * box.width / 4, y, { steps: 3 });
    await page.mouse.up();
    await page.keyboard.up('Shift');
    close((await state()).from, 4, 0.03, 'from');
    close((await state()).to, 6, 0.03, 'to');
    await page.click('text=Show the whole time');
    assert.equal((await state()).to, 8);
    assert.deepEqual(await page.locator('#legend tbody button').allTextContents(), ['shoulder', 'elbow']);
    await page.click('#legend button:has-text("shoulder")');
    assert.deepEqual((await state()).joints, ['elbow']);
    assert.equal(await page.getAttribute('#legend button:has-text("shoulder")', 'aria-pressed'), 'false');
  }));

  test('says what happens: push, limit, stop', () => open(SAMPLES['two-link'], { hash: 't=3.4&play=0' }, async ({ page }) => {
    assert.equal(await page.innerText('.push-words'), 'push of 2 N m');
    assert.match(await page.innerText('.badges'), /Limit\s+elbow: torque limit/);
    assert.equal(await page.locator('#marks button').count(), 3);
    await page.click('#marks .stop');
    await page.waitForTimeout(500);
    assert.match(await page.innerText('.badges'), /Stop\s+safe stop/);
    assert.equal(await page.locator('.push-words').isVisible(), false);
  }));

  test('stays at the last finite sample of a run that diverged', () => open(SAMPLES.diverging, { hash: 't=7&play=0' }, async ({ page, state }) => {
    const s = await state();
    assert.equal(s.t, 7);
    assert.ok(s.poses[0][0].every(Number.isFinite));
    assert.match(await page.innerText('.badges'), /Diverged[^]*last finite sample, 4\.81 s/);
    assert.match(await page.innerText('#runs'), /✕ bad/);
    assert.deepEqual([...new Set(await page.locator('#legend td').allInnerTexts())], ['–']);
  }));

  test('shows two runs side by side with one clock', () => open(SAMPLES.two, {}, async ({ page, state }) => {
    const s = await state();
    assert.deepEqual(s.runs, ['panda-sines', 'panda-sines-soft']);
    assert.equal(s.poses.length, 2);
    assert.equal(await page.locator('.stage canvas').count(), 2);
    assert.deepEqual(await page.locator('.which').allInnerTexts(), s.runs);
    assert.deepEqual(await page.locator('#legend tbody button').allTextContents(), Array.from({ length: 7 }, (_, j) => `panda_joint${j + 1}`));
    assert.equal(await page.title(), 'panda-sines and panda-sines-soft · Flexure');
  }));

  test('takes runs that differ in robot and joints', () => open(SAMPLES.unlike, {}, async ({ page, state }) => {
    assert.deepEqual((await state()).joints, ['shoulder', 'elbow', 'hinge']);
    assert.equal(await page.locator('.stage canvas').count(), 2);
  }));

  test('starts a long robot with the joints that err most', () => open(SAMPLES.snake, {}, async ({ page, state }) => {
    assert.deepEqual((await state()).joints, [35, 36, 37, 38, 39, 40].map(j => `segment_${j}`));
    assert.equal(await page.locator('#legend tbody tr').count(), 40);
    await page.click('#legend button:text-is("segment_1")');
    assert.equal((await state()).joints.length, 7);
  }));

  test('knows millimetres, branches and pendulums', async () => {
    await open(SAMPLES.gantry, {}, async ({ page }) => assert.match(await page.innerText('#legend thead'), /mrad, mm[^]*N m, N[^]*µrad, µm/));
    await open(SAMPLES.branched, {}, async ({ state }) => assert.equal((await state()).poses[0].length, 2));
    await open(SAMPLES.pendulum, {}, async ({ page, state }) => {
      const angle = 0.8 * Math.sin(1.5 * 1.23), [x, , z] = (await state()).poses[0][0];
      close(x, -0.12 * Math.sin(angle), 1e-4, 'x');
      close(z, -0.12 * Math.cos(angle), 1e-4, 'z');
      assert.match(await page.innerText('#legend thead'), /µrad/);
    });
  });

  test('says a sentence where there is nothing to show', async () => {
    const sentence = async (text, expected) => open(empty.replace('id="flexure-runs">null<', () => `id="flexure-runs">${text}<`), {}, async ({ page }) => assert.match(await page.innerText('body'), expected));
    await sentence('null', /holds no run/);
    await sentence('{"format": 1, "runs": [', /not valid JSON/);
    await sentence('{"format": 2, "runs": []}', /format 2/);
    await sentence('{"format": 1, "runs": [{"name": "x", "robot": {"bodies": []}}]}', /Run 1 \(x\) cannot be shown: its robot has no joints/);
  });

  test('shows its charts without WebGL', () => open(SAMPLES['two-link'], {
    prepare: () => { const own = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = function (kind, ...rest) { return kind.startsWith('webgl') ? null : own.call(this, kind, ...rest); }; },
  }, async ({ page, state }) => {
    assert.match(await page.innerText('.stage'), /no WebGL/);
    assert.ok(await page.locator('.u-over').count() >= 4);
    assert.equal((await state()).t, 1.23);
  }));

  test('prints a still picture and the charts', () => open(SAMPLES.two, { colorScheme: 'dark' }, async ({ page }) => {
    const stills = many => page.waitForFunction(n => document.querySelectorAll('img.still').length === n, many, { timeout: 10000, polling: 100 });
    await page.emulateMedia({ media: 'print' });
    await stills(2);
    assert.equal(await page.locator('.stage canvas').first().isVisible(), false);
    assert.equal(await page.locator('#player').isVisible(), false);
    await page.emulateMedia({ media: 'screen' });
    await stills(0);
  }));

  for (const [name, viewport] of [['wide', WIDE], ['phone', PHONE]]) {
    for (const sample of ['two-link', 'two', 'diverging', 'snake', 'branched', 'gantry']) {
      test(`keeps its words apart: ${sample}, ${name}`, () => open(SAMPLES[sample], { viewport, hash: 't=5.2&play=0' }, async ({ page }) => {
        const overlaps = await page.evaluate(() => {
          const boxes = [...document.querySelectorAll('.who, .verdict, .badges li, .which, #cell, #reset, #springs, #ghost, #key > span, #legend tbody tr, #legend thead, figcaption, .plot, #play, #restart, #bar, #clock, #speed')]
            .filter(element => element.checkVisibility()).map(element => {
              let { left, right, top, bottom } = element.getBoundingClientRect();
              // Of a box that scrolls only the part in sight counts; the player floats above the page on a phone.
              for (const frame of [element.closest('#legend')]) if (frame) { const f = frame.getBoundingClientRect(); top = Math.max(top, f.top); bottom = Math.min(bottom, f.bottom); if (element.matches('tr') && element.closest('tbody')) top = Math.max(top, document.querySelector('#legend thead').getBoundingClientRect().bottom); }
              return { name: element.className || element.id || element.tagName, left, right, top, bottom, floats: Boolean(element.closest('#player')) };
            }).filter(box => box.bottom - box.top > 1);
          const found = [];
          boxes.forEach((a, i) => boxes.slice(i + 1).forEach(b => {
            if (a.floats === b.floats && Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1) found.push(`${a.name} and ${b.name}`);
          }));
          const wide = [document.documentElement, document.querySelector('#legend')].filter(box => box.scrollWidth > box.clientWidth + 1).map(box => `${box.id || 'the page'} is wider than its place`);
          return [...new Set(found), ...wide];
        });
        assert.deepEqual(overlaps, []);
      }));
    }
  }

  for (const colorScheme of ['light', 'dark']) {
    test(`can be read: ${colorScheme}`, async () => {
      for (const sample of ['two-link', 'diverging', 'snake']) await open(SAMPLES[sample], { colorScheme, hash: 't=5.2&play=0' }, async ({ page }) => {
        const faint = await page.evaluate(() => {
          const numbers = colour => colour.match(/[\d.]+/g).map(Number), channel = c => (c /= 255, c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
          const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
          const behind = element => { for (let e = element; e; e = e.parentElement) { const c = numbers(getComputedStyle(e).backgroundColor); if ((c[3] ?? 1) === 1) return c; } return [255, 255, 255]; };
          const found = [], walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
          while (walk.nextNode()) {
            const element = walk.currentNode.parentElement;
            if (!walk.currentNode.textContent.trim() || !element.checkVisibility({ visibilityProperty: true }) || element.closest('script, noscript')) continue;
            const [a, b] = [light(numbers(getComputedStyle(element).color)), light(behind(element))], ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
            if (ratio < 4.5) found.push(`${walk.currentNode.textContent.trim().slice(0, 20)}: ${ratio.toFixed(2)}`);
          }
          return [...new Set(found)];
        });
        assert.deepEqual(faint, []);
      });
    });
  }
});
