// Strip charts of all joints that are switched on, under one time axis with one cursor.

import uPlot from 'uplot';
import { decimate } from './decimate.js';
import { usualPeak } from './data.js';
import { palette } from './theme.js';
import { digits } from './units.js';

const FONT = '12px system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';

export class Charts {
  /** `joints` says which are shown and in which colour, `clock` takes the clicks, `hover` is told where the mouse is. */
  constructor(host, runs, quantities, joints, clock, hover) {
    Object.assign(this, { host, runs, quantities, joints, clock, hover, from: clock.begin, to: clock.end });
    this.strips = quantities.map(quantity => this.strip(quantity));
    this.reset = document.createElement('button');
    this.reset.className = 'whole';
    this.reset.textContent = 'Show the whole time';
    this.reset.hidden = true;
    this.reset.addEventListener('click', () => this.zoom(clock.begin, clock.end));
    host.prepend(this.reset);
  }

  strip(quantity) {
    const figure = document.createElement('figure'), title = document.createElement('figcaption'), box = document.createElement('div');
    title.innerHTML = `<b>${quantity.title}</b> <span>${quantity.words}${quantity.note ? ` · ${quantity.note}` : ''}</span>`;
    box.className = 'plot';
    figure.append(title, box);
    this.host.append(figure);
    return { quantity, box, plot: null, cursor: null, hover: null };
  }

  /** Draws all charts anew for a size, a palette or another choice of joints. */
  draw(height = this.height, width = this.strips[0].box.clientWidth) {
    Object.assign(this, { height, width });
    if (!(width > 60)) return;
    for (const strip of this.strips) {
      // One axis of time, below the last chart, serves them all.
      const lowest = strip === this.strips.at(-1);
      strip.plot?.destroy();
      const { series, sources } = this.seriesOf(strip.quantity), colours = palette();
      const { x, y } = decimate(sources, this.from, this.to, Math.max(50, Math.round(width)));
      const axis = { stroke: colours.muted, font: FONT, grid: { stroke: colours.line, width: 1 }, ticks: { stroke: colours.line, width: 1, size: 4 } };
      strip.plot = new uPlot({
        width, height: height + (lowest ? 21 : 0), legend: { show: false }, cursor: { show: false }, padding: [6, 16, 0, 0],
        scales: { x: { time: false, range: [this.from, this.to] }, y: { range: (_, low, high) => this.rangeOf(strip.quantity, low, high) } },
        axes: [{ ...axis, size: lowest ? 26 : 5, gap: 3, ticks: { ...axis.ticks, show: lowest }, values: (_, ticks) => ticks.map(tick => (lowest ? `${tidy(tick)}${tick === ticks.at(-1) ? ' s' : ''}` : '')) }, { ...axis, size: 54, gap: 4, space: Math.min(24, Math.max(12, height / 5)), values: (_, ticks) => ticks.map(tidy) }],
        series: [{}, ...series],
        hooks: { drawClear: [plot => this.spans(plot)], draw: [plot => this.marks(plot, strip.quantity)] },
      }, [x, ...y], strip.box);
      strip.cursor = line('cursor', strip.plot.over);
      strip.hover = line('hover', strip.plot.over);
      this.listen(strip.plot);
    }
    this.seek(this.clock.t);
  }

  seriesOf(quantity) {
    const series = [], sources = [];
    this.runs.forEach((run, r) => {
      const dash = r ? [6, 4] : undefined;
      if (quantity.whole) {
        if (!run.certificate) return;
        series.push({ stroke: palette().ink, width: 1.6, dash, pxAlign: 0, points: { show: false } });
        sources.push({ t: run.t, last: run.last, values: run.certificate, factor: 1 });
        return;
      }
      for (const joint of this.joints.list) {
        const j = joint.at[r];
        if (!joint.shown || j < 0) continue;
        series.push({ stroke: palette().joints[joint.colour], width: 1.6, dash, pxAlign: 0, points: { show: false } });
        sources.push({ t: run.t, last: run.last, values: run[quantity.key][j], factor: quantity.factor });
      }
    });
    // An empty choice still draws its axes.
    if (!sources.length) { series.push({ show: false }); sources.push({ t: this.runs[0].t, last: this.runs[0].last, values: this.runs[0].t, factor: 1 }); }
    return { series, sources };
  }

  rangeOf(quantity, low, high) {
    if (!(high >= low)) return [-1, 1];
    // A run that diverged would press all before its end to a flat line.
    const wild = this.runs.filter(run => run.diverged);
    if (wild.length && !quantity.whole) {
      const usual = 1.6 * quantity.factor * Math.max(...this.runs.flatMap(run => this.joints.list.filter(joint => joint.shown && joint.at[this.runs.indexOf(run)] >= 0).map(joint => usualPeak(run, run[quantity.key][joint.at[this.runs.indexOf(run)]]))));
      if (usual > 0) { low = Math.max(low, -usual); high = Math.min(high, usual); }
    }
    const room = high > low ? 0.08 * (high - low) : Math.max(0.1 * Math.abs(high), 1e-3);
    return [low - room, high + room];
  }

  /** Times of pushes and stops, behind the lines. */
  spans(plot) {
    const { ctx, bbox } = plot, drawn = new Set();
    ctx.save();
    ctx.fillStyle = palette().span;
    for (const run of this.runs) for (const push of [...run.pushes, ...stops(run)]) {
      const key = `${push.from} ${push.to}`;
      if (drawn.has(key)) continue;
      drawn.add(key);
      const a = Math.max(bbox.left, plot.valToPos(push.from, 'x', true)), b = Math.min(bbox.left + bbox.width, plot.valToPos(push.to, 'x', true));
      if (b > a) ctx.fillRect(a, bbox.top, b - a, bbox.height);
    }
    ctx.restore();
  }

  /** Limits that lie in the range, one dotted line each. */
  marks(plot, quantity) {
    if (!quantity.limit) return;
    const { ctx, bbox } = plot, drawn = new Set();
    ctx.save();
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
    this.runs.forEach((run, r) => this.joints.list.forEach(joint => {
      const limit = run.limits[quantity.limit]?.[joint.at[r]];
      if (!joint.shown || !(limit > 0)) return;
      for (const value of [limit * quantity.factor, -limit * quantity.factor]) {
        if (value < plot.scales.y.min || value > plot.scales.y.max || drawn.has(value)) continue;
        drawn.add(value);
        const y = Math.round(plot.valToPos(value, 'y', true));
        ctx.strokeStyle = palette().joints[joint.colour];
        ctx.beginPath(); ctx.moveTo(bbox.left, y); ctx.lineTo(bbox.left + bbox.width, y); ctx.stroke();
        // One name is enough; two limits are often close.
        if (drawn.size > 1) continue;
        ctx.fillStyle = palette().muted; ctx.font = FONT.replace('12px', `${11 * devicePixelRatio}px`); ctx.textAlign = 'right'; ctx.textBaseline = value > 0 ? 'top' : 'bottom';
        ctx.fillText(`limit of ${joint.name}`, bbox.left + bbox.width - 4 * devicePixelRatio, y + (value > 0 ? 3 : -3) * devicePixelRatio);
      }
    }));
    ctx.restore();
  }

  /** Drag seeks; with shift it chooses a piece of time; twice shows the whole again. */
  listen(plot) {
    const { over } = plot, timeAt = event => plot.posToVal(Math.min(plot.bbox.width / devicePixelRatio, Math.max(0, event.clientX - over.getBoundingClientRect().left)), 'x');
    let start = null;
    over.addEventListener('pointerdown', event => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      start = { t: timeAt(event), piece: event.shiftKey };
      if (!start.piece) this.clock.seek(start.t);
    });
    over.addEventListener('pointermove', event => {
      const t = timeAt(event);
      if (start?.piece) this.select(start.t, t);
      else if (start) this.clock.seek(t);
      else if (event.pointerType === 'mouse') this.point(t);
    });
    over.addEventListener('pointerup', event => {
      if (start?.piece) {
        const t = timeAt(event), [a, b] = [Math.min(start.t, t), Math.max(start.t, t)];
        if (b - a > 0.004 * (this.to - this.from)) this.zoom(a, b); else this.select(0, 0);
      }
      start = null;
    });
    over.addEventListener('pointercancel', () => { start = null; });
    over.addEventListener('pointerleave', () => this.point(null));
    over.addEventListener('dblclick', () => this.zoom(this.clock.begin, this.clock.end));
  }

  select(a, b) {
    for (const { plot } of this.strips) {
      const [left, right] = [plot.valToPos(Math.min(a, b), 'x'), plot.valToPos(Math.max(a, b), 'x')];
      plot.setSelect({ left, width: b === a ? 0 : right - left, top: 0, height: plot.bbox.height / devicePixelRatio }, false);
    }
  }

  zoom(from, to) {
    Object.assign(this, { from, to });
    this.reset.hidden = from <= this.clock.begin && to >= this.clock.end;
    this.draw();
  }

  point(t) {
    this.hover(t);
    for (const { plot, hover } of this.strips) move(hover, plot, t);
  }

  seek(t) {
    for (const { plot, cursor } of this.strips) if (plot) move(cursor, plot, t);
  }
}

/** From when until when the robot was stopped. */
function stops(run) {
  return run.events.filter(event => event.kind === 'stop').map(stop => ({
    from: stop.t, to: run.events.find(event => event.kind === 'rejoin' && event.t >= stop.t)?.t ?? run.t[run.last],
  }));
}

// Without an exponent as long as there is room for it beside the frame.
const tidy = tick => (Math.abs(tick) >= 1e5 ? digits(tick) : plain(tick));
const plain = tick => String(Number(tick.toPrecision(8))).replace('-', '\u2212').replace(/e\+?/, '·10^');

function line(kind, over) {
  const element = document.createElement('i');
  element.className = `line ${kind}`;
  element.hidden = kind === 'hover';
  over.append(element);
  return element;
}

function move(element, plot, t) {
  const { min, max } = plot.scales.x, inside = t !== null && t >= min && t <= max;
  element.hidden = !inside;
  if (inside) element.style.transform = `translateX(${plot.valToPos(t, 'x').toFixed(2)}px)`;
}
