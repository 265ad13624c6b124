// The panels next to the path: step table, moves of a program, methods compared, block diagram, report.

class Panels {
  constructor(cursor, choose) {
    this.cursor = cursor;
    this.choose = choose;
    this.diagram = new DiagramView(cursor);
    this.names = ['steps', 'program', 'methods', 'diagram', 'report'];
    this.tabs = new Map(this.names.map((name) => {
      const tab = make('button', { type: 'button', role: 'tab', id: `${name}-button`, data: { word: name }, onclick: () => this.open(name) });
      tab.setAttribute('aria-controls', `${name}-tab`);
      $(`${name}-tab`).setAttribute('aria-labelledby', tab.id);
      return [name, tab];
    }));
    $('tabs').append(...this.tabs.values());
    $('tabs').addEventListener('keydown', (event) => {
      const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      const open = this.names.filter((name) => !this.tabs.get(name).hidden);
      const next = open[(open.indexOf(this.opened) + by + open.length) % open.length];
      this.open(next);
      this.tabs.get(next).focus();
    });
  }

  /** Takes another run. */
  show(run, comparison, index) {
    this.run = run;
    const has = {
      steps: Boolean(run.steps?.clocks.length),
      program: run.moves.length > 0,
      methods: Boolean(comparison),
      diagram: this.diagram.show(run),
      report: true,
    };
    for (const [name, tab] of this.tabs) tab.hidden = !has[name];
    this.steps = has.steps ? this.stepTable(run) : null;
    this.moves = has.program ? this.moveTable(run) : null;
    if (comparison && !this.methods) this.methods = this.methodTable(comparison);
    this.methods?.mark(index);
    this.report(run);
    const first = comparison && !this.opened ? 'methods' : run.moves.length ? 'program' : 'steps';
    this.open([this.opened, first, 'diagram', 'report'].find((name) => has[name]));
  }

  open(name) {
    this.opened = name;
    for (const [other, tab] of this.tabs) {
      tab.setAttribute('aria-selected', String(other === name));
      tab.tabIndex = other === name ? 0 : -1;
      $(`${other}-tab`).hidden = other !== name;
    }
    if (this.run) this.moved();
  }

  stepTable(run) {
    const { axes, table, counters, program } = run.interpolator;
    const registers = table.map(([name, net, reading]) => column(run, name, net, reading));
    const places = counters.map(([name, net, reading]) => column(run, name, net, reading));
    const { clocks, numbers, blocks, pulses } = run.steps;
    this.cells = (row) => [
      ...(program ? [numberOf(run.moves[blocks[row]])] : []),
      String(numbers[row]), String(clocks[row]),
      ...registers.map((register) => register.at(clocks[row])), ...pulses.map((axis) => String(axis[row])), ...places.map((place) => place.at(clocks[row])),
    ];
    const digits = (most) => String(most ?? 0).length;
    const columns = [
      ...(program ? [{ title: word('block'), chars: 5 }] : []),
      { title: word('step'), chars: Math.max(4, digits(numbers.at(-1))) },
      { title: word('clock'), chars: Math.max(5, digits(clocks.at(-1))) },
      ...registers.map(({ name, chars }) => ({ title: name, chars: Math.max(name.length, chars) })),
      ...axes.map((axis) => ({ title: `d${axis}`, chars: 3 })),
      ...places.map(({ name, chars }) => ({ title: name, chars: Math.max(3, chars) })),
    ];
    return new Table($('steps-tab'), {
      name: 'steps_of', columns, count: clocks.length, row: this.cells,
      pick: (row) => this.cursor.seek(clocks[row]),
    });
  }

  /** A line of the program each, with the move that it makes; or the moves alone where the text is not known. */
  moveTable(run) {
    const rows = [];
    const byLine = new Map();
    run.moves.forEach((move, index) => byLine.set(move.line, [...(byLine.get(move.line) ?? []), index]));
    const lines = run.text ? run.text.map((text, at) => [at + 1, text]) : [...byLine.keys()].map((line) => [line, '']);
    for (const [line, text] of lines) {
      const moves = byLine.get(line) ?? [null];
      moves.forEach((move, at) => rows.push({ line: at ? '' : String(line), text: at ? '' : text, move }));
    }
    this.rowOfMove = new Map(rows.map(({ move }, row) => [move, row]));
    const longest = Math.max(8, greatest(rows, ({ text }) => text.length));
    const speed = (feed, what) => {
      const turns = feed[`${what}_degrees_per_min`];
      const number = turns ?? feed[`${what}_mm_per_min`] ?? null;
      return number === null ? '' : `${real(number, 1)}${turns === undefined ? '' : '°'}`;
    };
    const cells = ({ line, text, move }) => {
      if (move === null) return [line, text, '', '', '', ''];
      const { kind, clocks, path_error, feed, end_point } = run.moves[move];
      const name = kindOf(run.moves[move]);
      const reached = speed(feed, 'reached');
      const feeds = kind === 'rapid' ? reached : `${speed(feed, 'commanded')} → ${reached}`;
      return [line, text, end_point.exact ? name : `${name} ✗`, shown(clocks), path_error.greatest.toFixed(3), feeds];
    };
    return new Table($('program-tab'), {
      name: 'program_of', count: rows.length, row: (at) => cells(rows[at]),
      columns: [
        { title: word('line'), chars: Math.max(4, String(rows.length).length) },
        { title: word('text'), chars: Math.min(24, longest), align: 'left', grows: true },
        { title: word('kind'), chars: greatest(run.moves, ({ kind }) => kind.length) + 1, align: 'left' }, { title: word('clocks'), chars: 8 },
        { title: word('error'), chars: 6 }, { title: word('feed'), chars: 15 },
      ],
      pick: (row) => rows[row].move !== null && this.cursor.seek(run.moves[rows[row].move].begun),
      style: (row) => (rows[row].move === null ? 'idle' : ''),
    });
  }

  methodTable({ heading, rows }) {
    const chars = heading.map((title, column) => Math.max(title.length, ...rows.map((row) => row[column].length)));
    return new Table($('methods-tab'), {
      name: 'methods_of', count: rows.length, row: (at) => rows[at],
      columns: heading.map((title, column) => ({ title, chars: chars[column], align: column === 0 || column > 5 ? 'left' : 'right' })),
      pick: (row) => this.choose(row),
    });
  }

  report(run) {
    const list = (name, sentences) => (sentences.length ? [make('ul', { className: name }, ...sentences.map((text) => make('li', { textContent: text })))] : []);
    $('report-tab').replaceChildren(
      ...list('failures', run.failures), ...list('warnings', run.warnings),
      make('pre', { textContent: run.summary.trim() }), make('p', { className: 'muted', textContent: run.title }),
    );
  }

  /** The cursor has moved. */
  moved() {
    const { clock, runs } = this.cursor;
    if (this.opened === 'steps') this.steps?.mark(this.run.row(clock), runs);
    if (this.opened === 'program') this.moves?.mark(this.rowOfMove.get(this.run.block(clock)) ?? -1, runs);
    this.diagram.moved();
  }
}

/** N word of a block, or its line. */
function numberOf(move) {
  return move ? String(move.n ?? move.line) : '';
}

/** A register of the step table: its value after a clock, read as its port says. */
function column(run, name, net, reading) {
  const of = run.nets[net];
  const signal = new Signal(run, { scopes: [], name, width: of.width, reading, drawn: 'bus', role: 'register', states: [], nets: [net] });
  return { name, chars: Math.ceil(of.width * 0.302) + 1, at: (clock) => String(signal.number(of.at(clock))) };
}
