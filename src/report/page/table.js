// Tables of any length: only the rows that are seen are in the page.

const LINE = 24;
/** Milliseconds between two pages of rows while the cursor runs through them. */
const PAUSE = 90;
/** Pixels that a browser lets an element be high, with room. */
const MOST_PIXELS = 8e6;

class Table {
  /**
   * In an element, with a name. `columns` have a title, an alignment and a number of characters; `row` gives the cells of
   * a row, `pick` is called with the row that is clicked.
   */
  constructor(element, { name, columns, count, row, pick, style }) {
    Object.assign(this, { element, columns, count, row, pick, style, current: -1 });
    const widths = columns.map(({ chars, grows }) => (grows ? `minmax(${chars}ch, 1fr)` : `calc(${chars}ch + 16px)`));
    this.template = widths.join(' ');
    this.head = make('div', { className: 'head', role: 'row' }, ...columns.map((column) => this.cell('columnheader', column, column.title)));
    this.space = make('div', { className: 'space', role: 'presentation' });
    this.body = make('div', { className: 'grid', role: 'grid', tabIndex: 0 }, this.head, this.space);
    this.body.setAttribute('aria-label', word(name));
    this.body.dataset.label = name;
    this.body.setAttribute('aria-rowcount', count + 1);
    this.head.style.gridTemplateColumns = this.template;
    const chars = columns.reduce((sum, column) => sum + column.chars, 0);
    this.head.style.minWidth = this.space.style.minWidth = `calc(${chars}ch + ${16 * columns.length + 12}px)`;
    this.height = Math.min(count * LINE, MOST_PIXELS);
    this.space.style.height = `${this.height}px`;
    element.replaceChildren(this.body);
    this.lines = [];
    // Kept, as asking an element for them lays the page out anew.
    [this.top, this.seen, this.turned] = [0, 0, -PAUSE];
    this.body.addEventListener('scroll', () => {
      this.top = this.body.scrollTop;
      this.draw();
    });
    new ResizeObserver(() => {
      this.seen = this.body.clientHeight;
      const { current } = this;
      this.current = -1;
      this.mark(current);
      this.draw();
    }).observe(this.body);
    this.space.addEventListener('click', (event) => {
      const line = event.target.closest('[data-row]');
      if (line) this.pick?.(Number(line.dataset.row));
    });
    this.draw();
  }

  cell(role, { align }, text) {
    return make('span', { role, className: align === 'left' ? 'left' : '', textContent: text });
  }

  /** Rows for each pixel of the scroll bar, which is 1 but for very long tables. */
  get ratio() {
    const room = Math.max(1, this.seen - LINE);
    return this.height < this.count * LINE ? (this.count * LINE - room) / Math.max(1, this.height - room) : 1;
  }

  /** Puts the rows that are seen into lines, which are used again. */
  draw() {
    const seen = Math.ceil(this.seen / LINE) + 1;
    const first = Math.max(0, Math.floor((this.top * this.ratio) / LINE));
    const offset = this.top - ((this.top * this.ratio) % LINE);
    const count = Math.min(seen, Math.max(0, this.count - first));
    while (this.lines.length < count) this.lines.push(this.line());
    this.lines.forEach((line, at) => {
      if (line.hidden !== at >= count) line.hidden = at >= count;
      if (at >= count) return;
      line.style.transform = `translateY(${Math.round(offset + at * LINE)}px)`;
      if (Number(line.dataset.row) !== first + at) this.fill(line, first + at);
    });
    this.first = first;
  }

  line() {
    const line = make('div', { role: 'row', data: { row: -1 } }, ...this.columns.map((column) => this.cell('gridcell', column, '')));
    line.id = `${this.element.id}-${this.lines.length}`;
    line.style.gridTemplateColumns = this.template;
    this.space.append(line);
    return line;
  }

  fill(line, row) {
    line.dataset.row = row;
    line.setAttribute('aria-rowindex', row + 2);
    this.row(row).forEach((text, column) => {
      setText(line.children[column], text);
    });
    line.className = this.style?.(row) ?? '';
    this.setCurrent(line, row === this.current);
  }

  setCurrent(line, is) {
    if (is) line?.setAttribute('aria-current', 'true'); else line?.removeAttribute('aria-current');
  }

  lineOf(row) {
    return this.lines.find((line) => Number(line.dataset.row) === row);
  }

  /** Marks a row and brings it into view, soon where the cursor `runs`. */
  mark(row, runs = false) {
    if (row === this.current) return;
    this.setCurrent(this.lineOf(this.current), false);
    this.current = row;
    clearTimeout(this.later);
    if (row < 0 || !this.seen) return;
    const top = this.top * this.ratio;
    if (row * LINE < top || row * LINE > top + this.seen - 2 * LINE) {
      // Another page is laid out anew as a whole: at once, but not in every frame.
      const wait = runs ? this.turned + PAUSE - performance.now() : 0;
      if (wait > 0) this.later = setTimeout(() => this.turn(), wait);
      else this.turn();
    }
    this.point();
  }

  /** Brings the marked row into view. */
  turn() {
    if (this.current < 0 || !this.seen) return;
    this.turned = performance.now();
    const most = Math.max(0, this.height + LINE - this.seen);
    this.top = Math.min(most, Math.round(Math.max(0, this.current * LINE - (this.seen - 2 * LINE) / 2) / this.ratio));
    this.body.scrollTop = this.top;
    this.draw();
    this.point();
  }

  /** Marks the line of the row where it is in view. */
  point() {
    const line = this.lineOf(this.current);
    this.setCurrent(line, true);
    if (line) this.body.setAttribute('aria-activedescendant', line.id);
  }
}
