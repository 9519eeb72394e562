// The view page: runs of robots with elastic joints, their motion and their charts under one clock.

import 'uplot/dist/uPlot.min.css';
import './style.css';
import { locate, readRuns } from './data.js';
import { formOf, linkSide, tipsOf } from './form.js';
import { framesFor, place } from './kinematics.js';
import { autoMagnification } from './arm.js';
import { largestSpring } from './body.js';
import { Badges } from './badges.js';
import { Charts } from './charts.js';
import { Clock } from './clock.js';
import { Joints, Legend } from './legend.js';
import { canDraw, Panel } from './scene.js';
import { colourBar, header, magnificationChoice, sayInstead } from './page.js';
import { forPaper } from './print.js';
import { isOnPaper, onTheme, palette } from './theme.js';
import { quantitiesOf } from './quantities.js';
import { lengthWords, roundNearest } from './units.js';
import { Timeline } from './timeline.js';

const byId = id => document.getElementById(id);
const narrow = matchMedia('(max-width: 899px)');

try {
  show(readRuns(byId('flexure-runs').textContent));
} catch (error) {
  sayInstead(error.message);
}

function show(runs) {
  const clock = new Clock(Math.min(...runs.map(run => run.begin)), Math.max(...runs.map(run => run.until)));
  const forms = runs.map(formOf), quantities = quantitiesOf(runs), joints = new Joints(runs), springScale = largestSpring(runs) || 1;
  const auto = Math.min(...runs.map((run, r) => autoMagnification(run, forms[r], roundNearest)));
  let magnification = auto, hovered = null, stale = true;

  header(runs);
  colourBar(springScale, [...new Set(runs.flatMap(run => run.prismatic.map(slides => (slides ? 'N' : 'N m'))))]);
  magnificationChoice(auto, factor => { magnification = factor; stale = true; });

  const drawable = canDraw(), stages = byId('stages');
  stages.dataset.runs = runs.length;
  const hosts = runs.map(run => {
    const host = document.createElement('section'), badges = document.createElement('ul');
    host.className = 'stage';
    host.setAttribute('aria-label', `motion of ${run.name}`);
    badges.className = 'badges';
    badges.setAttribute('role', 'status');
    host.append(badges);
    if (runs.length > 1) host.append(Object.assign(document.createElement('span'), { className: 'which', textContent: run.name }));
    if (!drawable) host.append(Object.assign(document.createElement('p'), { className: 'flat', textContent: 'This browser has no WebGL, so there is no 3-D picture here. The charts show the whole run.' }));
    stages.append(host);
    return host;
  });
  const panels = drawable ? runs.map((run, r) => new Panel(hosts[r], run, forms[r], springScale, magnification, palette())) : [];
  const badges = runs.map((run, r) => new Badges(hosts[r].querySelector('.badges'), run));
  byId('cell').textContent = panels.length ? `grid ${[...new Set(panels.map(panel => lengthWords(panel.stage.cell)))].join(' and ')}` : '';
  byId('reset').hidden = !panels.length;
  byId('reset').addEventListener('click', () => panels.forEach(panel => panel.resetView()));
  // Two runs of one robot are seen from one side.
  const alike = panels.length === 2 && runs[0].names.join() === runs[1].names.join() && Math.abs(forms[0].reach - forms[1].reach) < 1e-6 * forms[0].reach;
  panels.forEach((panel, p) => panel.controls.addEventListener('start', () => { panel.moved = true; panels.leader = p; }));
  if (alike) panels.forEach((panel, p) => panel.controls.addEventListener('change', () => { if (panel.moved && panels.leader === p) panels[1 - p].follow(panel); }));

  const timeline = new Timeline(byId('player'), clock, runs);
  const legend = new Legend(byId('legend'), runs, quantities, joints, () => layout());
  const charts = new Charts(byId('charts'), runs, quantities, joints, clock, t => { hovered = t; legend.show(t ?? clock.t, t !== null); });
  clock.addEventListener('seek', () => { stale = true; });

  function layout() {
    // A sheet of paper has its own sizes; what the window does meanwhile must not undo them.
    if (isOnPaper()) return;
    panels.forEach(panel => panel.resize());
    const room = byId('aside').clientHeight - byId('legend').offsetHeight - 40;
    charts.draw(narrow.matches ? 130 : Math.min(230, Math.max(62, (room - 21) / quantities.length - 27)));
    stale = true;
  }
  layout();
  new ResizeObserver(layout).observe(byId('aside'));
  panels.forEach((panel, p) => new ResizeObserver(() => { if (!isOnPaper()) { panel.resize(); stale = true; } }).observe(hosts[p]));
  onTheme(colours => { panels.forEach(panel => panel.theme(colours)); legend.theme(); charts.draw(); });
  forPaper(panels, charts, layout);

  const at = runs.map(() => ({ k: 0, f: 0 })), q = runs.map(run => new Float64Array(run.n)), frames = forms.map(form => framesFor(form.chain));
  let before = performance.now(), told = 0, counted = 0, since = before, rate = 0, slow = 0;
  function frame(now) {
    clock.advance((now - before) / 1000);
    before = now;
    counted++;
    if (now - since >= 1000) {
      rate = 1000 * counted / (now - since);
      counted = 0;
      since = now;
      slow = clock.playing && rate < 24 && !document.hidden ? slow + 1 : 0;
      // One slow second may be the start or another program; two are the machine.
      if (slow > 1) { panels.forEach(panel => panel.ease()); slow = 0; }
    }
    if (clock.playing || stale) {
      runs.forEach((run, r) => locate(run, clock.t, at[r]));
      panels.forEach((panel, p) => panel.pose(clock.t, at[p], magnification));
      badges.forEach(badge => badge.at(clock.t));
      charts.seek(clock.t);
      timeline.show();
      // Numbers that change faster cannot be read.
      if (stale || now - told > 90) { told = now; if (hovered === null) legend.show(clock.t, false); }
      stale = false;
    }
    panels.forEach(panel => panel.render());
    requestAnimationFrame(frame);
  }

  clock.addEventListener('play', () => { stale = true; });
  function fromHash() {
    const wanted = new URLSearchParams(location.hash.slice(1)), t = Number.parseFloat(wanted.get('t'));
    if (Number.isFinite(t)) clock.seek(t);
    return wanted.get('play') !== '0';
  }
  addEventListener('hashchange', () => clock.play(fromHash()));
  clock.play(fromHash() && !matchMedia('(prefers-reduced-motion: reduce)').matches);
  requestAnimationFrame(frame);

  window.flexure = {
    state: () => ({
      t: clock.t, playing: clock.playing, speed: clock.speed, runs: runs.map(run => run.name), magnification,
      joints: joints.shown.map(joint => joint.name), from: charts.from, to: charts.to, fps: rate,
      poses: runs.map((run, r) => tipsOf(forms[r], place(forms[r].chain, linkSide(run, locate(run, clock.t, at[r]), q[r]), frames[r]))),
    }),
  };
}
