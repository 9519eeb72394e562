// The scrub bar with its marks, the buttons beside it and the keys.

import { SPEEDS } from './clock.js';
import { signOf, wordsOf } from './badges.js';
import { seconds } from './units.js';

/** Of marks closer than this many pixels only the gravest is drawn. */
const APART = 12, WEIGHT = ['diverged', 'fault', 'stop', 'limit', 'rejoin'];

export class Timeline {
  constructor(host, clock, runs) {
    this.clock = clock;
    const find = name => host.querySelector(name);
    this.play = find('#play'); this.slider = find('#scrub'); this.time = find('#time');
    Object.assign(this.slider, { min: clock.begin, max: clock.end, step: 'any', value: clock.t });
    find('#end').textContent = `/ ${seconds(clock.end)}`;
    this.play.addEventListener('click', () => clock.toggle());
    find('#restart').addEventListener('click', () => clock.restart());
    this.slider.addEventListener('input', () => clock.seek(Number(this.slider.value)));
    const speed = find('#speed');
    speed.append(...SPEEDS.map(s => new Option(`× ${s}`, s, s === 1, s === 1)));
    speed.addEventListener('change', () => { clock.speed = Number(speed.value); });
    this.marks(find('#marks'), runs);
    clock.addEventListener('play', () => this.show());
    addEventListener('keydown', event => this.key(event));
    this.show();
  }

  marks(host, runs) {
    const { begin, end } = this.clock, apart = APART / Math.max(200, host.clientWidth), share = t => (end > begin ? (t - begin) / (end - begin) : 0);
    runs.forEach((run, r) => {
      for (const push of run.pushes) {
        const span = document.createElement('span'), a = Math.max(0, share(push.from)), b = Math.min(1, share(push.to));
        span.className = 'push';
        span.style.cssText = `left:${100 * a}%;width:${100 * Math.max(0.002, b - a)}%`;
        span.title = push.words;
        host.append(span);
      }
      const placed = [];
      for (const event of [...run.events].sort((a, b) => WEIGHT.indexOf(a.kind) - WEIGHT.indexOf(b.kind))) {
        const x = share(event.t);
        if (x < 0 || x > 1 || placed.some(other => Math.abs(other - x) < apart)) continue;
        placed.push(x);
        const mark = document.createElement('button'), { name, words } = wordsOf(event, run);
        mark.type = 'button';
        mark.tabIndex = -1;
        mark.className = event.kind;
        mark.style.left = `${100 * x}%`;
        mark.textContent = signOf(event.kind);
        mark.title = `${seconds(event.t)}: ${[name, words].filter(Boolean).join(', ')}${runs.length > 1 ? ` (${run.name})` : ''}`;
        mark.setAttribute('aria-label', mark.title);
        mark.addEventListener('click', () => this.clock.seek(event.t));
        host.append(mark);
      }
    });
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || event.target.matches('select')) return;
    const { clock } = this, step = (clock.end - clock.begin) / (event.shiftKey ? 20 : 200);
    const moves = { ArrowLeft: clock.t - step, ArrowRight: clock.t + step, Home: clock.begin, End: clock.end };
    if (event.key === ' ') clock.toggle();
    else if (event.key in moves) clock.seek(moves[event.key]);
    else return;
    event.preventDefault();
  }

  show() {
    const { clock } = this;
    this.play.textContent = clock.playing ? 'Pause' : 'Play';
    this.play.classList.toggle('on', clock.playing);
    this.slider.value = clock.t;
    this.slider.style.setProperty('--share', clock.end > clock.begin ? (clock.t - clock.begin) / (clock.end - clock.begin) : 0);
    this.slider.setAttribute('aria-valuetext', seconds(clock.t));
    this.time.textContent = seconds(clock.t);
  }
}
