// Drawing surfaces and gestures: sharp on every screen, in the colours of the style, by mouse, pen and fingers.

const $ = (id) => document.getElementById(id);

/** A new element with properties, in the place of none. */
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  const { data, role, ...rest } = properties;
  Object.assign(element, rest);
  if (role) element.setAttribute('role', role);
  for (const [name, value] of Object.entries(data ?? {})) element.dataset[name] = value;
  element.append(...children);
  return element;
}

/** Writes a text in the place of that in an element: its node stays. */
function setText(element, text) {
  const node = element.firstChild;
  if (!node) element.textContent = text;
  else if (node.data !== text) node.data = text;
}

/** Shapes of signs, in a square of 16. */
const SIGNS = {
  first: 'M3 3h2v10H3zM13 3v10L6 8z', last: 'M11 3h2v10h-2zM3 3v10l7-5z', play: 'M4 2.5v11l9-5.5z', pause: 'M4 3h3v10H4zM9 3h3v10H9z',
  before_block: 'M8 3v10L2 8zM14 3v10L8 8z', next_block: 'M2 3v10l6-5zM8 3v10l6-5z', before_step: 'M11 3v10L4 8z',
  next_step: 'M5 3v10l7-5z', fit: 'M2 2h5v2H4v3H2zM9 2h5v5h-2V4H9zM2 9h2v3h3v2H2zM12 9h2v5H9v-2h3z', zoom_in: 'M7 3h2v4h4v2H9v4H7V9H3V7h4z',
  zoom_out: 'M3 7h10v2H3z', light: 'M8 5a3 3 0 1 1 0 6 3 3 0 0 1 0-6zM7 1h2v2H7zM7 13h2v2H7zM1 7h2v2H1zM13 7h2v2h-2z',
  large: 'M2 2h6L5.5 4.5 8 7 7 8 4.500 5.500 2 8zM14 14H8l2.500-2.500L8 9l1-1 2.500 2.500L14 8z',
  dark: 'M10 1.5A6.5 6.5 0 1 0 14.5 10 5.5 5.5 0 0 1 10 1.5z',
};

/** A sign that is drawn. */
function sign(name) {
  const svg = $('sign').content.firstElementChild.cloneNode(true);
  svg.firstElementChild.setAttribute('d', SIGNS[name]);
  return svg;
}

/** A button with a sign, and a word as its name; some signs are text. */
function button(name, key, go, text) {
  const made = make('button', { type: 'button', onclick: go, data: { title: name } }, text ?? sign(name));
  if (key) made.dataset.key = key;
  return made;
}

/** The colours of the style, read anew when they change. */
let colours = {};
const COLOURS = ['panel', 'ink', 'muted', 'line', 'grid', 'accent', 'pale', 'ideal', 'bit', 'bus', 'busfill', 'bad', 'cursor', 'band', 'rapid', 'curve'];

function readColours() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(COLOURS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

/** Canvases over each other in an element, drawn when something asked for it, once a frame. */
class Surface {
  constructor(element, layers) {
    this.element = element;
    this.layers = layers.map((draw) => {
      const canvas = make('canvas');
      canvas.setAttribute('aria-hidden', 'true');
      element.append(canvas);
      return { canvas, draw, context: canvas.getContext('2d'), stale: true };
    });
    this.width = this.height = 0;
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    const ratio = window.devicePixelRatio || 1;
    if (width === this.width && height === this.height && ratio === this.ratio) return;
    Object.assign(this, { width, height, ratio });
    for (const layer of this.layers) {
      layer.canvas.width = Math.round(width * ratio);
      layer.canvas.height = Math.round(height * ratio);
    }
    this.resized?.();
    this.redraw();
  }

  /** Draws a layer, or all, in the next frame. */
  redraw(only) {
    this.layers.forEach((layer, index) => { layer.stale ||= only === undefined || only === index; });
    this.frame ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    if (this.frame) cancelAnimationFrame(this.frame);
    this.frame = undefined;
    if (!this.width || !this.height) return;
    for (const layer of this.layers.filter(({ stale }) => stale)) {
      layer.stale = false;
      layer.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
      layer.context.clearRect(0, 0, this.width, this.height);
      layer.draw(layer.context, this.width, this.height);
    }
  }
}

/**
 * Calls of what hands do: `drag` with one pointer, `pan` and `zoom` with two or with the wheel, `tap` without moving.
 * Places are relative to the element.
 */
function gestures(element, { press, drag, release, tap, pan, zoom, wheel }) {
  const pointers = new Map();
  let moved = false;
  const place = (event) => {
    const box = element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const middle = () => {
    const [a, b] = [...pointers.values()];
    return { at: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], apart: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  };
  element.addEventListener('pointerdown', (event) => {
    if (event.button > 1) return;
    pointers.set(event.pointerId, place(event));
    element.setPointerCapture(event.pointerId);
    moved = pointers.size > 1;
    if (pointers.size === 1) press?.(place(event), event);
  });
  element.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    if (pointers.size === 2) {
      const from = middle();
      pointers.set(event.pointerId, now);
      const to = middle();
      pan?.([to.at[0] - from.at[0], to.at[1] - from.at[1]]);
      if (from.apart > 4) zoom?.(to.apart / from.apart, to.at);
      return;
    }
    moved ||= Math.hypot(now[0] - before[0], now[1] - before[1]) > 3;
    if (moved) {
      pointers.set(event.pointerId, now);
      drag?.([now[0] - before[0], now[1] - before[1]], now, event);
    }
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    if (!moved && event.type === 'pointerup') tap?.(place(event), event);
    if (!pointers.size) release?.();
  };
  element.addEventListener('pointerup', up);
  element.addEventListener('pointercancel', up);
  element.addEventListener('wheel', (event) => wheel?.(event, place(event)), { passive: false });
}

/** How much a turn of the wheel zooms. */
function wheelFactor(event) {
  const pixels = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
  return Math.exp(-Math.max(-200, Math.min(200, pixels)) / 300);
}

/** The step of ticks, 1, 2 or 5 times a power of ten and at least `finest`, that takes this many pixels. */
function tickStep(scale, room, finest) {
  for (let decade = finest; ; decade *= 10) {
    for (const factor of [1, 2, 5]) if (decade * factor * scale >= room) return decade * factor;
  }
}
