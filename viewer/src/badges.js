// Badges on the picture while something happens: stops, limits, faults, a divergence.

const LASTS = 1.5, MOST = 4;
const SIGNS = { stop: '■', limit: '▲', fault: '✕', diverged: '!', rejoin: '↻' };
const NAMES = { stop: 'Stop', limit: 'Limit', fault: 'Fault', diverged: 'Diverged', rejoin: 'Rejoins' };

export const signOf = kind => SIGNS[kind] ?? '•';

/** An event in words, with the joint it is about. */
export function wordsOf(event, run) {
  const name = NAMES[event.kind] ?? event.kind, joint = event.joint === null || event.joint === undefined ? '' : run.names[event.joint] ?? '';
  // What the name says already, the words need not say again.
  const words = event.words?.toLowerCase().startsWith(name.toLowerCase()) ? event.words.slice(name.length).trim() : event.words ?? '';
  return { name, words: joint && !words.includes(joint) ? [joint, words].filter(Boolean).join(': ') : words };
}

export class Badges {
  constructor(host, run) {
    Object.assign(this, { host, run, now: '' });
    // A stop holds until the robot rejoins; a divergence for good; all else for a moment.
    this.events = run.events.map((event, i) => {
      const rejoin = run.events.find(other => other.kind === 'rejoin' && other.t > event.t);
      const until = event.kind === 'diverged' ? Infinity : event.kind === 'stop' && rejoin ? rejoin.t : event.t + LASTS;
      return { ...event, i, until };
    });
  }

  at(t) {
    let active = this.events.filter(event => event.t <= t && t < event.until);
    // Of one kind at one joint only the latest.
    active = active.filter((event, k) => !active.some((other, m) => m > k && other.kind === event.kind && other.joint === event.joint && other.words === event.words));
    const key = active.map(event => event.i).join();
    if (key === this.now) return;
    this.now = key;
    const badges = active.slice(-MOST).map(event => {
      const badge = document.createElement('li'), { name, words } = wordsOf(event, this.run);
      badge.className = event.kind;
      badge.innerHTML = `<b><span aria-hidden="true">${signOf(event.kind)}</span> ${name}</b>`;
      if (words) badge.append(` ${words}`);
      if (event.kind === 'diverged') badge.append(document.createElement('br'), `the arm stays at its last finite sample, ${this.run.end.toFixed(2)} s`);
      return badge;
    });
    if (active.length > MOST) {
      const more = document.createElement('li');
      more.textContent = `and ${active.length - MOST} more`;
      badges.unshift(more);
    }
    this.host.replaceChildren(...badges);
  }
}
