// The block diagram: an SVG of the netlist, whose elements carry the index of their net in `data-net`, bound to the cursor.
//
// A text with `data-net` shows the value of the net; every element with it has the value in `data-value`, for the style, and
// one with `data-component`, paths of flags, is of the class `raised` in the clocks in which one of them is 1. A box with
// `data-scope` opens the drawing of that scope, a drawing of its own; the way back is a list of the drawings above it.

/** The smallest and the largest diagram, as parts of what it is in a document. */
const SCALES = [0.1, 4];

class DiagramView {
  constructor(cursor) {
    this.cursor = cursor;
    this.element = $('diagram-tab');
    this.note = make('p', { className: 'muted' });
    this.trail = make('ol');
    this.crumbs = make('nav', { className: 'crumbs', data: { label: 'scopes_of' } }, this.trail);
    this.sheet = make('div', { className: 'sheet', tabIndex: 0 });
    this.sheet.setAttribute('role', 'group');
    this.tools = make('div', { className: 'tools', hidden: true },
      button('zoom_in', '', () => this.zoom(1.3)), button('zoom_out', '', () => this.zoom(1 / 1.3)),
      button('fit', '', () => this.fit()), button('large', '', () => this.large()));
    $('tabs').after(this.tools);
    this.element.append(this.note, this.crumbs, this.sheet);
    this.sheet.addEventListener('wheel', (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), event);
    }, { passive: false });
    this.sheet.addEventListener('pointerdown', () => { this.dragged = 0; });
    this.sheet.addEventListener('pointermove', ({ buttons, movementX, movementY }) => {
      if (!(buttons & 1)) return;
      this.dragged += Math.abs(movementX) + Math.abs(movementY);
      this.sheet.scrollBy(-movementX, -movementY);
    });
    // A click that ends a drag opens nothing.
    this.sheet.addEventListener('click', ({ target, detail }) => { if (!detail || this.dragged < 4) this.enter(target); });
    this.element.addEventListener('keydown', (event) => this.key(event));
  }

  /** Opens the box that an element is; false if it is none that opens. */
  enter(box) {
    const index = this.sheets.findIndex(({ scope }) => scope === box.dataset?.scope);
    if (index > 0) this.open(index);
    return index > 0;
  }

  /** Enter or Space opens the box with the focus, Backspace or Escape goes back to the drawing that it is in. */
  key(event) {
    const above = this.above(this.shown).at(-1);
    const opens = ['Enter', ' '].includes(event.key) && this.enter(event.target);
    const closes = ['Backspace', 'Escape'].includes(event.key) && above !== undefined;
    if (closes) this.open(above);
    if (opens || closes) event.preventDefault();
  }

  /** The drawings in which one is a box, the outermost first: those whose scopes are around its own. */
  above(index) {
    const isAround = ({ scope }) => this.sheets[index].scope.startsWith(`${scope}.`);
    return [...this.sheets.keys()].filter((other) => isAround(this.sheets[other]));
  }

  /** Shows another drawing; the focus goes to it, or to the box that was left. */
  open(index) {
    const left = this.sheets[this.shown].scope;
    this.draw(index);
    const box = [...this.svg.querySelectorAll('[data-scope]')].find(({ dataset }) => `${left}.`.startsWith(`${dataset.scope}.`));
    (box ?? this.sheet).focus({ preventScroll: !box });
  }

  /** Takes another run; true if it has a diagram, or says why not. */
  show(run) {
    const isOther = run !== this.run;
    [this.run, this.sheets] = [run, run.diagrams ?? []];
    this.note.textContent = run.diagram_note ?? '';
    this.note.hidden = !run.diagram_note;
    this.draw(isOther ? 0 : this.shown);
    return this.sheets.length > 0 || Boolean(run.diagram_note);
  }

  /** Draws the whole, or a scope that is a box in another drawing. */
  draw(index) {
    const { run } = this;
    this.sheet.replaceChildren();
    [this.parts, this.components, this.scale, this.svg, this.shown] = [[], [], null, null, index];
    this.crumbs.hidden = this.sheets.length < 2;
    if (!this.sheets.length) return;
    const parsed = new DOMParser().parseFromString(this.sheets[index].svg, 'image/svg+xml').documentElement;
    this.svg = document.importNode(parsed, true);
    this.sheet.append(this.svg);
    this.name();
    for (const element of this.svg.querySelectorAll('[data-net]')) {
      const net = run.byNet.get(Number(element.dataset.net));
      if (!net) continue;
      const signal = run.signals.find(({ nets }) => nets.length === 1 && nets[0] === net);
      this.parts.push({ element, net, signal, isText: element.localName === 'text' });
    }
    const flags = run.signals.filter(({ role }) => role === 'flag');
    this.components = [...this.svg.querySelectorAll('[data-component]')].map((element) => {
      const paths = element.dataset.component.split(' ');
      return { element, flags: flags.filter(({ path }) => paths.includes(path)) };
    });
    this.moved();
  }

  /** Says which drawing this is, what is above it, and which boxes can be opened. */
  name() {
    const above = this.above(this.shown);
    const outer = above.length ? this.sheets[above.at(-1)].scope.length + 1 : 0;
    this.sheet.setAttribute('aria-label', `${word('diagram')}: ${this.sheets[this.shown].scope}`);
    this.svg.setAttribute('role', 'group');
    const crumb = (index, at) => {
      const { scope } = this.sheets[index];
      const text = at ? scope.slice(this.sheets[above[at - 1]].scope.length + 1) : scope;
      return make('li', {}, make('button', { type: 'button', textContent: text, onclick: () => this.open(index) }));
    };
    const here = make('li', { textContent: this.sheets[this.shown].scope.slice(outer) });
    here.setAttribute('aria-current', 'location');
    this.trail.replaceChildren(...above.map(crumb), here);
    for (const box of this.svg.querySelectorAll('[data-scope]')) {
      if (!this.sheets.some(({ scope }) => scope === box.dataset.scope)) continue;
      box.classList.add('opens');
      box.setAttribute('tabindex', '0');
      box.setAttribute('role', 'button');
      box.setAttribute('aria-label', `${word('open')} ${box.dataset.scope}: ${box.textContent}`);
    }
  }

  /** Shows all of it, if there is room. */
  fit() {
    if (!this.svg) return;
    const { width, height } = this.svg.viewBox.baseVal;
    const { clientWidth, clientHeight } = this.sheet;
    this.scale = Math.max(SCALES[0], Math.min(1.5, (clientWidth - 4) / width, (clientHeight - 4) / height));
    this.size();
  }

  size() {
    this.svg.style.width = `${this.svg.viewBox.baseVal.width * this.scale}px`;
  }

  /** Larger or smaller; what is under the pointer, or in the middle, stays there. */
  zoom(by, pointer) {
    const { sheet } = this;
    const box = sheet.getBoundingClientRect();
    const at = pointer ? [pointer.clientX - box.left, pointer.clientY - box.top] : [sheet.clientWidth / 2, sheet.clientHeight / 2];
    const place = [(sheet.scrollLeft + at[0]) / this.scale, (sheet.scrollTop + at[1]) / this.scale];
    this.scale = Math.min(SCALES[1], Math.max(SCALES[0], this.scale * by));
    this.size();
    sheet.scrollTo(place[0] * this.scale - at[0], place[1] * this.scale - at[1]);
  }

  /** All of the page, or its panel again. */
  large() {
    document.body.classList.toggle('large-side');
    requestAnimationFrame(() => this.fit());
  }

  moved() {
    this.tools.hidden = this.element.hidden || !this.svg;
    if (this.tools.hidden) return;
    if (!this.scale && this.sheet.clientWidth) this.fit();
    const { clock, radix } = this.cursor;
    for (const part of this.parts) {
      const bits = part.net.at(clock);
      if (bits === part.bits && radix === part.radix) continue;
      Object.assign(part, { bits, radix });
      part.element.dataset.value = String(bits);
      if (part.isText) part.element.textContent = part.signal ? part.signal.text(bits, radix) : String(bits);
    }
    for (const { element, flags } of this.components) {
      element.classList.toggle('raised', flags.some((flag) => flag.bits(clock) === 1));
    }
  }
}
