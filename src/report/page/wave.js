// The wave: a tree of signals with their values at the cursor, and their changes over time.

const ROW = 24, CURVE = 64;
const FONT = '12px ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace';

class WaveView {
  constructor(cursor) {
    this.cursor = cursor;
    [this.rows, this.list, this.element] = [$('rows'), $('values'), $('waves')];
    this.surface = new Surface(this.element, [(context) => this.drawWaves(context)]);
    this.ruler = new Surface($('ruler'), [(context) => this.drawRuler(context)]);
    // The cursor is no part of a drawing, so that a move of it draws nothing anew.
    [this.line, this.label] = [make('div', { className: 'line' }), make('div', { className: 'label' })];
    this.element.append(this.line);
    $('ruler').append(this.label);
    this.surface.resized = () => {
      this.clamp();
      this.drawCursor();
    };
    // Kept, as asking an element for them lays the page out anew.
    [this.top, this.height] = [0, 0];
    this.rows.addEventListener('scroll', () => {
      this.top = this.rows.scrollTop;
      this.surface.redraw();
      this.values(false);
    });
    new ResizeObserver(() => this.place()).observe(this.rows);
    const scrub = {
      press: ([x]) => cursor.seek(this.clockAt(x)),
      drag: (_, [x]) => cursor.seek(this.clockAt(x), true),
      pan: ([dx]) => this.pan(dx),
      zoom: (factor, [x]) => this.zoom(factor, x),
      wheel: (event, [x]) => this.wheel(event, x),
    };
    gestures(this.element, scrub);
    gestures($('ruler'), scrub);
    this.list.addEventListener('click', (event) => this.select(event.target.closest('li'), true));
    this.list.addEventListener('focusin', (event) => this.select(event.target.closest('li'), false));
    $('filter').addEventListener('input', () => this.arrange());
    $('wave-tools').append(
      button('zoom_in', '+', () => this.zoom(1.6)), button('zoom_out', '\u2212', () => this.zoom(1 / 1.6)), button('fit', '0', () => this.fit()),
    );
  }

  /** Takes another run. */
  show(run) {
    this.run = run;
    this.items = [];
    this.closed = new Set();
    this.selected = null;
    const flags = run.signals.filter(({ role }) => role === 'flag');
    const [raised, down] = [flags.filter(rises), flags.filter((flag) => !rises(flag))];
    if (raised.length) this.addScope([word('raised')], raised);
    const leading = run.leading.map((path) => run.byPath.get(`${run.signals[0].scopes[0]}.${path}`)).filter(Boolean);
    if (leading.length) this.addScope([word('leading')], leading);
    for (const [scopes, signals] of scopesOf(run, leading)) this.addScope(scopes, signals);
    if (down.length) this.addScope([word('flags')], down, true);
    this.list.replaceChildren(...this.items.map(({ element }) => element));
    this.list.firstChild?.setAttribute('tabindex', '0');
    const longest = greatest(run.signals, ({ name, scopes }) => name.length + 2 * scopes.length);
    const widest = Math.min(24, greatest(run.signals, (signal) => this.digits(signal)));
    $('wave').style.setProperty('--names', `calc(${Math.min(44, longest + widest) + 4}ch + 20px)`);
    this.arrange();
    this.fit();
  }

  addScope(scopes, signals, shut = false) {
    const path = scopes.join('.');
    const level = scopes.length;
    const sign = make('span', { className: 'sign', textContent: '▾' });
    sign.setAttribute('aria-hidden', 'true');
    const group = make('li', { role: 'treeitem', className: 'scope', data: { scope: path } }, sign, make('span', { textContent: scopes.at(-1) }));
    group.setAttribute('aria-level', level);
    group.style.setProperty('--level', level);
    group.tabIndex = -1;
    group.setAttribute('aria-expanded', String(!shut));
    if (shut) this.closed.add(path);
    this.items.push({ element: group, scope: path, height: ROW });
    for (const signal of signals) {
      const value = make('span', { className: 'value' });
      const name = make('span', { className: 'name', textContent: signal.name });
      const element = make('li', { role: 'treeitem', className: signal.role, title: `${signal.path}, ${signal.width} bit` , data: { name: signal.path } }, name, value);
      element.setAttribute('aria-level', level + 1);
      element.style.setProperty('--level', level + 1);
      element.tabIndex = -1;
      const height = signal.drawn === 'curve' ? CURVE : ROW;
      if (height === CURVE) element.classList.add('curve');
      this.items.push({ element, signal, value, height, within: path, flagged: signal.role === 'flag' });
    }
  }

  /** Characters that the values of a signal take. */
  digits({ width, states }) {
    return Math.max(Math.ceil(width * 0.302) + 1, ...[...(states?.values() ?? [])].map((name) => name.length));
  }

  /** Which items are shown, and where. */
  arrange() {
    const sought = $('filter').value.trim().toLowerCase();
    const fits = ({ signal }) => signal.path.toLowerCase().includes(sought);
    // A scope with all that it is in, beginning with itself.
    const around = (path) => path.split('.').map((_, depth, parts) => parts.slice(0, parts.length - depth).join('.'));
    const found = this.items.filter((item) => item.signal && fits(item));
    const holding = new Set(found.flatMap(({ within }) => around(within)));
    const isOpen = (path) => sought !== '' || !around(path).some((scope) => this.closed.has(scope));
    const visible = ({ signal, scope, within }) => {
      if (signal) return (sought === '' || fits({ signal })) && isOpen(within);
      return holding.has(scope) && isOpen(scope.split('.').slice(0, -1).join('.'));
    };
    let top = 0;
    this.shown = this.items.filter((item) => {
      item.element.hidden = !visible(item);
      if (item.element.hidden) return false;
      item.top = top;
      top += item.height;
      return true;
    });
    this.total = top;
    this.place();
    this.surface.redraw();
    this.values(true);
  }

  /** The canvas covers what is seen of the rows. */
  place() {
    this.height = this.rows.clientHeight;
    this.element.style.height = `${this.height}px`;
    this.surface.resize();
  }

  toggle(item) {
    if (!item.scope) return;
    if (!this.closed.delete(item.scope)) this.closed.add(item.scope);
    item.element.setAttribute('aria-expanded', String(!this.closed.has(item.scope)));
    this.arrange();
  }

  select(element, isClick) {
    const item = this.items.find((item) => item.element === element);
    if (!item) return;
    if (isClick) item.element.focus({ preventScroll: true });
    if (isClick && item.scope) this.toggle(item);
    if (this.selected === item) return;
    this.selected?.element.removeAttribute('aria-selected');
    this.list.querySelector('[tabindex="0"]')?.setAttribute('tabindex', '-1');
    item.element.setAttribute('aria-selected', 'true');
    item.element.tabIndex = 0;
    this.selected = item;
    this.surface.redraw();
  }

  /** Selects the item before or after the selected one. */
  selectNext(by) {
    const at = this.shown.indexOf(this.selected);
    const item = this.shown[Math.max(0, Math.min(this.shown.length - 1, at + by))];
    item?.element.focus({ preventScroll: true });
    item?.element.scrollIntoView({ block: 'nearest' });
  }

  // Time

  get scale() {
    return this.surface.width / (this.to - this.from);
  }

  clockAt(x) {
    return Math.floor(this.from + x / this.scale);
  }

  fit() {
    [this.from, this.to] = [this.run.first, this.run.last + 1];
    this.changed();
  }

  /** Within the run, and not closer than some clocks. */
  clamp() {
    if (!this.run) return;
    const [first, last] = [this.run.first, this.run.last + 1];
    const least = Math.min(last - first, Math.max(2, this.surface.width / 120));
    const length = Math.max(least, Math.min(last - first, this.to - this.from));
    const from = Math.max(first, Math.min(last - length, this.from));
    [this.from, this.to] = [from, from + length];
  }

  zoom(factor, x) {
    const { clock } = this.cursor;
    const seen = clock >= this.from && clock < this.to;
    const at = x === undefined ? (seen ? clock + 0.5 : (this.from + this.to) / 2) : this.from + x / this.scale;
    const part = (at - this.from) / (this.to - this.from);
    const length = (this.to - this.from) / factor;
    [this.from, this.to] = [at - part * length, at + (1 - part) * length];
    this.changed();
  }

  pan(dx) {
    const by = -dx / this.scale;
    [this.from, this.to] = [this.from + by, this.to + by];
    this.changed();
  }

  wheel(event, x) {
    if (event.ctrlKey || event.metaKey || event.altKey) {
      event.preventDefault();
      this.zoom(wheelFactor(event), x);
    } else if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
      event.preventDefault();
      this.pan(-(event.deltaX || event.deltaY));
    }
  }

  changed() {
    this.clamp();
    this.surface.redraw();
    this.ruler.redraw();
    this.drawCursor();
  }

  /** The cursor has moved: it stays in view. */
  moved() {
    const { clock } = this.cursor;
    const length = this.to - this.from;
    if (clock < this.from || clock + 1 > this.to) {
      const from = clock < this.from ? clock - length * 0.1 : clock - length * 0.9 + 1;
      [this.from, this.to] = [from, from + length];
      this.changed();
    }
    this.drawCursor();
    this.values(false);
  }

  /** The values at the cursor: of all signals, or of those in view first and of the others soon. */
  values(all) {
    if (!this.run) return;
    const [top, bottom] = [this.top - ROW, this.top + this.height];
    const { clock, radix } = this.cursor;
    for (const item of this.items) {
      if (!item.signal) continue;
      const inView = !item.element.hidden && item.top > top - CURVE && item.top < bottom;
      if (!all && !inView) continue;
      const bits = item.signal.bits(clock);
      if (bits === item.bits && radix === item.radix && item.signal.radix === item.own) continue;
      Object.assign(item, { bits, radix, own: item.signal.radix });
      item.element.dataset.value = String(item.signal.number(bits));
      setText(item.value, item.signal.text(bits, radix));
      if (item.flagged) item.element.classList.toggle('raised', bits === 1);
    }
    if (all) return;
    clearTimeout(this.later);
    this.later = setTimeout(() => this.values(true), 120);
  }
}

/** A flag is 1 somewhere. */
function rises({ nets: [net] }) {
  return net.values.includes(1);
}

/** The scopes of a run with their signals, but flags and those that lead: those that hold inputs last, as the test bench's side of the machine. */
function scopesOf(run, leading) {
  const scopes = new Map();
  for (const signal of run.signals) {
    for (let depth = 1; depth <= signal.scopes.length; depth++) {
      const path = signal.scopes.slice(0, depth).join('\0');
      if (!scopes.has(path)) scopes.set(path, []);
    }
    if (signal.role !== 'flag' && !leading.includes(signal)) scopes.get(signal.scopes.join('\0')).push(signal);
  }
  const all = [...scopes].map(([path, signals]) => [path.split('\0'), signals]);
  const isBench = ([path, signals]) => path.length > 1 && signals.some(({ role }) => role === 'input');
  // The operands of the cell that stopped the run.
  const isTrap = ([path]) => path.length === 2 && path[1] === 'trap';
  const place = (scope) => (isTrap(scope) ? 0 : isBench(scope) ? 2 : 1);
  return all.sort((a, b) => place(a) - place(b));
}
