// Colours of what is drawn on canvases; the rest of the page takes its colours from the style sheet.

const LIGHT = {
  ground: '#eef0f2', grid: '#aab2bc', shadow: 0.2, ink: '#1f2328', muted: '#59636e', line: '#dfe3e7', paper: '#fbfbfa',
  ghost: '#7b5ea7', veil: 0.42, reference: '#1f9d76', trail: '#30363d', push: '#b3401f', span: '#b3401f1c',
  joints: ['#0072b2', '#d55e00', '#009e73', '#aa4499', '#a07800', '#2f9fd8', '#5b5f66', '#cc3355'],
};
const DARK = {
  ground: '#1a1e22', grid: '#59636e', shadow: 0.42, ink: '#e6e8ea', muted: '#9aa4ae', line: '#2c3238', paper: '#15181b',
  ghost: '#b79cec', veil: 0.55, reference: '#37c896', trail: '#dfe3e7', push: '#ff8a5c', span: '#ff8a5c26',
  joints: ['#56b4e9', '#f0883e', '#2fc99b', '#d88bd0', '#d9b13b', '#8ecdf5', '#a7afb8', '#ff7b95'],
};

const dark = matchMedia('(prefers-color-scheme: dark)');
let onPaper = false;
const listeners = [];

export const palette = () => (dark.matches && !onPaper ? DARK : LIGHT);
export const isOnPaper = () => onPaper;
export const onTheme = listener => listeners.push(listener);

/** Paper is white whatever the screen shows. */
export function setPaper(on) {
  const was = palette();
  onPaper = on;
  if (palette() !== was) listeners.forEach(listener => listener(palette()));
}

dark.addEventListener('change', () => listeners.forEach(listener => listener(palette())));

// Spring torque on the hubs and on the colour bar: blue is slack, yellow half, red the largest.
export const RAMP = ['#3a6db3', '#7fb0cf', '#f1d27a', '#e5853f', '#c2302b'];
