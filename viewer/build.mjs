// Writes the view page: modules, style and notices in one HTML file. With --check it only compares.

import { readFileSync, writeFileSync } from 'node:fs';
import { build } from 'esbuild';

const here = path => new URL(path, import.meta.url);
const target = here('../crates/flexure/src/report/view.html');
const RUNS = '<script type="application/json" id="flexure-runs">null</script>';

export async function page() {
  const { outputFiles } = await build({
    entryPoints: ['src/main.js'], absWorkingDir: here('.').pathname, bundle: true, minify: true, format: 'iife', target: 'es2022', charset: 'utf8',
    legalComments: 'inline', write: false, outdir: 'out', logLevel: 'error',
  });
  const text = suffix => outputFiles.find(file => file.path.endsWith(suffix)).text.trim();
  const notices = ['three', 'uplot'].map(name => {
    const { version } = JSON.parse(readFileSync(here(`node_modules/${name}/package.json`), 'utf8'));
    return `${name} ${version}\n\n${readFileSync(here(`node_modules/${name}/LICENSE`), 'utf8').trim()}`;
  });
  const parts = {
    '<!--NOTICES-->': `<!--\nThis page contains the following libraries.\n\n${notices.join('\n\n')}\n-->`,
    '/*STYLE*/': text('.css'),
    '/*PROGRAM*/': text('.js').replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--'),
  };
  let html = readFileSync(here('src/page.html'), 'utf8');
  for (const [place, part] of Object.entries(parts)) html = html.replace(place, () => part);
  if (html.split(RUNS).length !== 2) throw new Error('the page must hold the place of the runs exactly once');
  return html;
}

if (process.argv[1] === here(import.meta.url).pathname) {
  const html = await page();
  if (process.argv.includes('--check')) {
    let committed = '';
    try { committed = readFileSync(target, 'utf8'); } catch { /* a page that is missing differs, too */ }
    if (committed !== html) {
      console.error('crates/flexure/src/report/view.html is not what viewer/ builds: run `npm ci && npm run build` in viewer/ and commit the page');
      process.exit(1);
    }
    console.log('view.html is up to date');
  } else {
    writeFileSync(target, html);
    console.log(`view.html: ${Buffer.byteLength(html)} bytes`);
  }
}
