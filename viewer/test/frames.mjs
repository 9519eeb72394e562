// Frames a second of pages in motion, as Chromium of this machine draws them: node test/frames.mjs PAGE… [--seconds S] [--software]
// At several sizes, with what draws: on a machine without a graphics processor that is software, and says little of one with.

import { existsSync, readFileSync, statSync } from 'node:fs';
import { basename } from 'node:path';
import { parseArgs } from 'node:util';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const SIZES = [[640, 360], [1280, 720], [1920, 1080]];
const { values: { seconds, software }, positionals: pages } = parseArgs({ allowPositionals: true, options: { seconds: { type: 'string', default: '5' }, software: { type: 'boolean', default: false } } });
if (!pages.length || !(Number(seconds) > 0)) {
  console.error('node test/frames.mjs PAGE… [--seconds S] [--software]: pages that `flexure run --view` wrote');
  process.exit(2);
}
for (const path of pages) {
  const is = existsSync(path) && statSync(path).isFile() && readFileSync(path, 'utf8').includes('id="flexure-runs"');
  if (!is) {
    console.error(`${path}: no page in motion; \`flexure run SCENARIO --view\` writes NAME.view.html`);
    process.exit(2);
  }
}

const drawn = software ? ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--ignore-gpu-blocklist', '--enable-gpu', '--enable-unsafe-swiftshader'];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', ...drawn] });
console.log('| page | size | frames a second | slowest of 20, ms | drawn by |\n| --- | ---: | ---: | ---: | --- |');
for (const path of pages) {
  for (const [width, height] of SIZES) {
    const page = await browser.newPage({ viewport: { width, height } });
    await page.goto(`${pathToFileURL(path).href}#t=0.5`);
    await page.waitForTimeout(1000);
    const seen = await page.evaluate(async seconds => {
      const gaps = [];
      await new Promise(done => {
        let before = 0;
        const start = performance.now();
        const frame = now => {
          if (before) gaps.push(now - before);
          before = now;
          if (now - start < 1000 * seconds) requestAnimationFrame(frame);
          else done();
        };
        requestAnimationFrame(frame);
      });
      const gl = document.createElement('canvas').getContext('webgl2'), info = gl?.getExtension('WEBGL_debug_renderer_info');
      const sorted = gaps.toSorted((a, b) => a - b);
      return { rate: 1000 * gaps.length / gaps.reduce((sum, gap) => sum + gap, 0), slow: sorted[Math.floor(0.95 * (gaps.length - 1))], playing: window.flexure.state().playing, by: info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'nothing' };
    }, Number(seconds));
    console.log(`| ${basename(path)} | ${width} × ${height} | ${seen.rate.toFixed(0)} | ${seen.slow.toFixed(1)} | ${seen.by}${seen.playing ? '' : ', at rest'} |`);
    await page.close();
  }
}
await browser.close();
