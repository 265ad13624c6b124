// The block diagram: an SVG of the netlist, whose elements carry the index of their net in `data-net`, bound to the cursor.
//
// A text with `data-net` shows the value of the net; every element with it has the value in `data-value`, for the style, and
// one with `data-component`, paths of flags, is of the class `raised` in the clocks in which one of them is 1.

/** The smallest and the largest diagram, as parts of what it is in a document. */
const SCALES = [0.1, 4];

class DiagramView {
  constructor(cursor) {
    this.cursor = cursor;
    this.element = $('diagram-tab');
    this.note = make('p', { className: 'muted' });
    this.sheet = make('div', { className: 'sheet', tabIndex: 0 });
    this.tools = make('div', { className: 'tools', hidden: true },
      button('zoom_in', '', () => this.zoom(1.3)), button('zoom_out', '', () => this.zoom(1 / 1.3)),
      button('fit', '', () => this.fit()), button('large', '', () => this.large()));
    $('tabs').after(this.tools);
    this.element.append(this.note, this.sheet);
    this.sheet.addEventListener('wheel', (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), event);
    }, { passive: false });
    this.sheet.addEventListener('pointermove', ({ buttons, movementX, movementY }) => {
      if (buttons & 1) this.sheet.scrollBy(-movementX, -movementY);
    });
  }

  /** Takes another run; true if it has a diagram, or says why not. */
  show(run) {
    this.sheet.replaceChildren();
    [this.parts, this.components, this.scale, this.svg] = [[], [], null, null];
    this.note.textContent = run.diagram_note ?? '';
    this.note.hidden = !run.diagram_note;
    if (!run.diagram) return Boolean(run.diagram_note);
    const parsed = new DOMParser().parseFromString(run.diagram, 'image/svg+xml').documentElement;
    this.svg = document.importNode(parsed, true);
    this.sheet.append(this.svg);
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
    return true;
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
