// The block diagram: an SVG of the netlist, whose elements carry the index of their net in `data-net`, bound to the cursor.
//
// A text with `data-net` shows the value of the net; every element with it has the value in `data-value`, for the style, and
// one with `data-component`, the path of a property, is of the class `raised` in the clocks in which that is violated.

class DiagramView {
  constructor(cursor) {
    this.cursor = cursor;
    this.element = $('diagram-tab');
  }

  /** Takes another run; true if it has a diagram. */
  show(run) {
    this.element.replaceChildren();
    this.parts = [];
    if (!run.diagram) return false;
    const parsed = new DOMParser().parseFromString(run.diagram, 'image/svg+xml').documentElement;
    const svg = document.importNode(parsed, true);
    this.element.append(svg);
    for (const element of svg.querySelectorAll('[data-net]')) {
      const net = run.byNet.get(Number(element.dataset.net));
      if (!net) continue;
      const signal = run.signals.find(({ nets }) => nets.length === 1 && nets[0] === net);
      this.parts.push({ element, net, signal, isText: element.localName === 'text' });
    }
    this.components = [...svg.querySelectorAll('[data-component]')].map((element) => {
      const flags = run.signals.filter(({ role, path }) => role === 'flag' && path.startsWith(element.dataset.component));
      return { element, flags };
    });
    this.moved();
    return true;
  }

  moved() {
    if (!this.parts?.length || this.element.hidden) return;
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
