//! Block diagrams of every model: what is drawn, and that a reader can read it. The file is read anew, without the layout.

mod reading;

use std::collections::BTreeSet;

use stepwave::models::options::Options;
use stepwave::models::{catalogue, find};
use stepwave::netlist::cells::{Op, ScopeId};
use stepwave::netlist::{Net, Netlist, text};
use stepwave::schematic::{DrawError, Drawing, Part, draw, outputs};
use stepwave::testbench::Testbench;

use reading::Figure;

/// The machine of every model, for the samples of its curve; of a model of program moves the first of them.
fn machines() -> Vec<(String, Netlist, Vec<Net>)> {
    let mut machines = Vec::new();
    for model in catalogue().iter() {
        for curve in model.curve().samples().unwrap() {
            if let Ok(bench) = Testbench::new(model, &curve, &Options::at_1_mhz()) {
                machines.push((model.name.to_owned(), bench.design().netlist().clone(), bench.ports()));
                break;
            }
        }
    }
    machines
}

fn all(netlist: &Netlist, outputs: &[Net]) -> Drawing {
    draw(netlist, outputs, &Part { depth: Some(9), ..Part::default() }).unwrap()
}

#[test]
fn every_model_has_a_drawing_that_can_be_read() {
    let machines = machines();
    assert_eq!(machines.len(), catalogue().len());
    for (name, netlist, outputs) in machines {
        let closed = draw(&netlist, &outputs, &Part { depth: Some(0), ..Part::default() }).unwrap();
        assert_eq!(Figure::read(&closed.svg).faults(), Vec::<String>::new(), "{name} with closed scopes");
        let drawn = all(&netlist, &outputs);
        let figure = Figure::read(&drawn.svg);
        assert_eq!(figure.faults(), Vec::<String>::new(), "{name}");
        // A wire crosses others about as often as there are symbols, or the order of the columns is bad.
        let crossings = figure.crossings();
        assert!(crossings <= 8 * drawn.symbols, "{name}: {crossings} crossings of {} symbols", drawn.symbols);
    }
}

/// Nets of registers, adders and comparators that registers or outputs depend on: flags alone need none.
fn wanted(netlist: &Netlist, outputs: &[Net]) -> BTreeSet<usize> {
    let flags: BTreeSet<Net> = netlist.properties.iter().map(|property| property.never).collect();
    let registers = netlist.nets().filter(|&net| matches!(netlist.cell(net).op, Op::Register { .. }));
    let mut pending: Vec<Net> = registers.chain(outputs.iter().copied()).filter(|net| !flags.contains(net)).collect();
    let mut seen = BTreeSet::new();
    let mut wanted = BTreeSet::new();
    while let Some(net) = pending.pop() {
        if !seen.insert(net) {
            continue;
        }
        let op = netlist.cell(net).op;
        if matches!(
            op,
            Op::Register { .. } | Op::Add(..) | Op::Sub(..) | Op::Mul(..) | Op::Div(..) | Op::LessSigned(..)
        ) {
            wanted.insert(net.index());
        }
        // What a constant select never takes is not hardware.
        match op {
            Op::Register { next, .. } => pending.extend(next),
            Op::Mux { select, high, low } => match netlist.cell(select).op {
                Op::Const(value) => pending.push(if value == 1 { high } else { low }),
                _ => pending.extend([select, high, low]),
            },
            _ => op.visit_inputs(|input| pending.push(input)),
        }
    }
    wanted
}

#[test]
fn registers_and_adders_are_all_there_with_their_widths() {
    for (name, netlist, outputs) in machines() {
        let figure = Figure::read(&all(&netlist, &outputs).svg);
        let drawn: BTreeSet<usize> = figure.cells.keys().copied().collect();
        let missing: Vec<usize> = wanted(&netlist, &outputs).difference(&drawn).copied().collect();
        // A constant that logic makes of constants is not looked for in `wanted`: it may be a part that is never taken.
        assert!(missing.is_empty(), "{name}: {missing:?}");
        for (&cell, frame) in &figure.cells {
            let bits = netlist.cells[cell].width.get();
            if matches!(netlist.cells[cell].op, Op::Register { .. }) {
                let plural = if bits == 1 { "" } else { "s" };
                let texts = figure.texts_in(frame);
                let note = format!("{bits} bit{plural}");
                assert!(texts.iter().any(|text| text.starts_with(&note)), "{name}: %{cell} {texts:?}");
            }
        }
    }
}

/// A register, named in a scope, that counts up or down and is compared.
const COUNTER: &str = "netlist m\nscope 1 in 0 \"part\"\n%0:1 = input\n%1:1 = input\n%2:4 = register reset 0x0 next %7\n\
    %3:4 = const 0x1\n%4:4 = add %2 %3\n%5:4 = sub %2 %3\n%6:4 = mux %1 %4 %5\n%7:4 = mux %0 %6 %2\n\
    %8:4 = const 0x9\n%9:1 = equal %2 %8\n%10:1 = carry %2 %3\n%11:1 = and %0 %10\n\
    name %0 in 0 \"go\" unsigned\nname %1 in 0 \"up\" unsigned\nname %2 in 1 \"count\" unsigned\n\
    name %9 in 0 \"nine\" unsigned\nname %11 in 1 \"count_add_overflow\" unsigned\n\
    property \"m.part.count\" never %11 add %2 unsigned %3 unsigned\n";

#[test]
fn a_counter_is_drawn_as_a_textbook_draws_it() {
    let netlist = text::parse(COUNTER).unwrap();
    let drawn = draw(&netlist, &[Net(9)], &Part::default()).unwrap();
    let figure = Figure::read(&drawn.svg);
    let texts: Vec<&str> = figure.texts.iter().map(|text| text.text.as_str()).collect();
    for wanted in ["go", "up", "part", "count", "4 bits", "± 1", "count = 9", "nine"] {
        assert!(texts.contains(&wanted), "{wanted}: {texts:?}");
    }
    // The flag is at the register and at the adder, and its logic is not drawn.
    assert_eq!(drawn.svg.matches("data-component=\"m.part.count_add_overflow\"").count(), 2);
    assert!(!figure.cells.contains_key(&11) && !figure.cells.contains_key(&10));
    // Both are in the scope.
    let scope = figure.frames.iter().find(|frame| frame.class == "scope").unwrap();
    assert!(scope.holds(&figure.cells[&2]) && scope.holds(&figure.cells[&4]));
}

#[test]
fn scopes_are_closed_below_a_depth_and_one_can_be_drawn_alone() {
    let netlist = text::parse(COUNTER).unwrap();
    let part = |scope: Option<&str>, depth| Part { scope: scope.map(str::to_owned), depth, most: None };
    let closed = draw(&netlist, &[Net(9)], &part(None, Some(0))).unwrap();
    assert_eq!((closed.depth, closed.levels), (0, 1));
    let figure = Figure::read(&closed.svg);
    assert_eq!(figure.faults(), Vec::<String>::new());
    assert!(figure.texts.iter().any(|text| text.text.starts_with("1 register, ")), "{}", closed.svg);
    assert_eq!(figure.closed.iter().map(|closed| closed.path.as_str()).collect::<Vec<_>>(), ["m.part"]);
    assert!(!figure.texts.iter().any(|text| text.text == "± 1"));
    for path in ["part", "m.part"] {
        let alone = draw(&netlist, &[], &part(Some(path), None)).unwrap();
        assert!(alone.svg.contains(">± 1<") && !alone.svg.contains("class=\"scope\""), "{}", alone.svg);
    }
    let error = draw(&netlist, &[], &part(Some("prat"), None)).unwrap_err();
    assert!(matches!(&error, DrawError::NoScope { path, .. } if path == "prat"));
    assert!(error.to_string().starts_with("no scope is called 'prat'"), "{error}");
}

#[test]
fn a_netlist_is_always_drawn_alike() {
    let model = find("ppc-arc").unwrap();
    let curve = model.curve().samples().unwrap().remove(0);
    let bench = Testbench::new(model, &curve, &Options::default()).unwrap();
    let draw = || all(bench.design().netlist(), &bench.ports()).svg;
    assert_eq!(draw(), draw());
}

/// A flat netlist as it is imported: output ports that logic reads too, that have one net with another port, or an input's,
/// and a named net that nothing reads.
const PORTS: &str = "netlist m\n%0:1 = input\n%1:4 = register reset 0x0 next %8\n%2:4 = const 0x1\n%3:4 = add %1 %2\n\
    %4:1 = slice %1 3\n%5:1 = xor %0 %4\n%6:1 = const 0x0\n%7:4 = const 0x9\n%8:4 = mux %0 %3 %7\nname %0 in 0 \"go\" unsigned\n\
    name %1 in 0 \"count\" output unsigned\nname %1 in 0 \"again\" output unsigned\nname %0 in 0 \"through\" output unsigned\n\
    name %6 in 0 \"zero\" output unsigned\nname %7 in 0 \"nine\" output unsigned\nname %5 in 0 \"dead\" unsigned\n";

#[test]
fn every_port_that_a_netlist_declares_is_drawn_as_one_and_nothing_else() {
    let netlist = text::parse(PORTS).unwrap();
    assert_eq!(text::print(&netlist), PORTS);
    // Whatever else is asked for as an output.
    for asked in [outputs(&netlist), vec![]] {
        let figure = Figure::read(&draw(&netlist, &asked, &Part::default()).unwrap().svg);
        assert_eq!(figure.faults(), Vec::<String>::new());
        let ports = figure.frames.iter().filter(|frame| frame.class == "port");
        let mut ports: Vec<&str> = ports.flat_map(|frame| figure.texts_in(frame)).collect();
        ports.sort_unstable();
        assert_eq!(ports, ["again", "count", "go", "nine", "through", "zero"]);
        // A constant is written where it is read, also where an output has it.
        assert!(figure.texts.iter().any(|text| text.text == "else: 9"), "{:?}", figure.texts);
    }
    // Where none is declared, what nothing reads is one.
    let undeclared = text::parse(&PORTS.replace(" output ", " ")).unwrap();
    assert_eq!(outputs(&undeclared), [Net(6), Net(5)]);
}

/// The netlist as a synthesiser leaves it: every name at the top, with the scopes that it was in before it.
fn flattened(netlist: &Netlist) -> Netlist {
    let mut flat = netlist.clone();
    let place = |scope| netlist.scope_path(scope).split('.').skip(1).map(|word| format!("{word}_")).collect::<String>();
    for named in &mut flat.names {
        named.name = place(named.scope) + &named.name;
        named.scope = ScopeId::TOP;
    }
    for memory in &mut flat.memories {
        memory.name = place(memory.scope) + &memory.name;
        memory.scope = ScopeId::TOP;
    }
    flat.scopes.truncate(1);
    flat
}

/// Draws a netlist without scopes as it is drawn by default, each of its groups alone, and both with all scopes closed.
fn groups_can_be_read(what: &str, netlist: &Netlist, outputs: &[Net], most: usize) -> usize {
    let mut pending = vec![None];
    let mut drawings = 0;
    while let Some(scope) = pending.pop() {
        let name = scope.as_deref().unwrap_or("all");
        for depth in [None, Some(0)] {
            let part = Part { scope: scope.clone(), depth, ..Part::default() };
            let drawn = draw(netlist, outputs, &part).unwrap();
            let figure = Figure::read(&drawn.svg);
            assert_eq!(figure.faults(), Vec::<String>::new(), "{what}: {name}");
            assert!(drawn.symbols <= most, "{what}: {name} has {} symbols", drawn.symbols);
            // Closed groups have more wires than symbols have: those of a net count as those of one.
            let (crossings, nets) = (figure.crossings(), figure.nets());
            assert!(crossings <= 8 * (drawn.symbols + nets), "{what}: {name}: {crossings} crossings of {nets} nets");
            // What is closed can be opened, by the path that is said.
            assert_eq!(drawn.closed().is_some(), !drawn.scopes.is_empty(), "{what}: {name}");
            assert_eq!(figure.closed.len(), drawn.scopes.len(), "{what}: {name}");
            pending.extend(drawn.scopes.into_iter().map(Some).filter(|_| depth.is_none()));
        }
        drawings += 1;
    }
    drawings
}

/// Every net between two closed boxes, or between one and a symbol, has a wire or is named at both ends: the boxes say which
/// cells are in them, so that the nets follow from the netlist alone.
fn named_at_boxes(what: &str, netlist: &Netlist, drawn: &Drawing) -> usize {
    let figure = Figure::read(&drawn.svg);
    let boxes: Vec<&reading::Closed> = figure.closed.iter().collect();
    let mut named_nets = 0;
    for net in netlist.nets() {
        // Of the nets with a name those of registers: what reads one directly is a wire of it.
        let Some(named) = netlist.name_of(net) else { continue };
        let (Op::Register { .. }, Some(from)) = (netlist.cell(net).op, boxes.iter().find(|closed| closed.holds(net)))
        else {
            continue;
        };
        for to in boxes.iter().filter(|to| !std::ptr::eq(**to, *from)) {
            let mut reads = false;
            for &cell in &to.cells {
                netlist.cells[cell].op.visit_inputs(|input| reads |= input == net);
            }
            if reads && !figure.has_wire(net.index()) {
                assert!(from.names("gives").contains(&named.name.as_str()), "{what}: {} at its driver", named.name);
                assert!(to.names("reads").contains(&named.name.as_str()), "{what}: {} at a reader", named.name);
                named_nets += 1;
            }
        }
    }
    named_nets
}

#[test]
fn a_netlist_without_scopes_is_drawn_in_groups_that_can_be_opened() {
    let (mut grouped, mut unwired, mut named) = (0, 0, 0);
    for (name, netlist, outputs) in machines() {
        let flat = flattened(&netlist);
        let inputs = netlist.cells.iter().filter(|cell| cell.op == Op::Input).count();
        let open = all(&flat, &outputs);
        if open.levels == 0 {
            // What can be read as it is stays so.
            assert!(open.symbols <= 135 + inputs, "{name}: {} symbols", open.symbols);
            continue;
        }
        grouped += 1;
        let drawn = draw(&flat, &outputs, &Part::default()).unwrap();
        assert!(drawn.symbols - inputs.min(drawn.symbols) <= 40, "{name}: {} symbols", drawn.symbols);
        assert!(groups_can_be_read(&name, &flat, &outputs, 60 + inputs) > 4, "{name}");
        // Nets without a wire are counted where groups are closed, and all have one where they are open.
        unwired += drawn.unwired;
        let counted = format!("{} nets of closed groups have no wire", drawn.unwired);
        assert_eq!(drawn.closed().unwrap().contains(&counted), drawn.unwired > 1, "{name}");
        named += named_at_boxes(&name, &flat, &drawn);
        assert_eq!(open.unwired, 0, "{name}");
        // Every register is in one of them.
        let whole = draw(&flat, &outputs, &Part { depth: Some(9), ..Part::default() }).unwrap();
        let drawn: BTreeSet<usize> = Figure::read(&whole.svg).cells.keys().copied().collect();
        let missing = &wanted(&flat, &outputs) - &drawn;
        assert!(missing.is_empty(), "{name}: {missing:?}");
    }
    // `.ci/import` names a folder of processors that others wrote.
    for path in std::env::var("STEPWAVE_NETLISTS").into_iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()) {
        let path = path.unwrap().path();
        let netlist = text::parse(&std::fs::read_to_string(&path).unwrap()).unwrap();
        // Scopes of their own that can be read as they are stay so.
        assert!(groups_can_be_read(&path.display().to_string(), &netlist, &outputs(&netlist), 135) > 4);
    }
    assert!(grouped > 0 && unwired > 1 && named > 1, "{grouped} {unwired} {named}");
}

#[test]
fn groups_have_names_that_no_scope_has() {
    let mut lines = String::from("netlist m\nscope 1 in 0 \"alu\"\nscope 2 in 0 \"aliases\"\n");
    let (mut cells, mut names) = (String::new(), String::new());
    for at in 0..160 {
        let (begin, next) = (if at < 80 { "alu" } else { "mem" }, (at + 1) % 160);
        cells += &format!("%{at}:4 = register reset 0x0 next %{next}\n");
        names += &format!("name %{at} in 0 \"{begin}_{at}\" unsigned\n");
    }
    // The scope of that name, and one that has but another name of a net.
    cells += "%160:4 = register reset 0x0 next %0\n";
    names += "name %160 in 1 \"held\" unsigned\nname %7 in 2 \"seventh\" unsigned\n";
    lines += &(cells + &names);
    let netlist = text::parse(&lines).unwrap();
    let drawn = draw(&netlist, &[], &Part { depth: Some(0), ..Part::default() }).unwrap();
    assert!(["alu", "alu_2", "mem"].iter().all(|name| drawn.scopes.iter().any(|scope| scope == name)), "{drawn:?}");
    let cells = |path: &str| {
        let part = Part { scope: Some(path.to_owned()), depth: Some(9), most: None };
        draw(&netlist, &[], &part).map(|drawn| Figure::read(&drawn.svg).cells.keys().copied().collect::<BTreeSet<_>>())
    };
    assert_eq!(cells("alu").unwrap(), BTreeSet::from([160]));
    assert_eq!(cells("alu_2").unwrap(), (0..80).collect());
    // Nothing is drawn of a scope without symbols, and no message proposes it.
    assert_eq!(cells("aliases"), Err(DrawError::Empty { scope: "m.aliases".to_owned() }));
    let error = cells("none at all").unwrap_err().to_string();
    assert!(error.contains("there are alu, alu_2, ") && !error.contains("aliases"), "{error}");
}

#[test]
fn ports_of_a_memory_say_what_they_are() {
    let (_, netlist, outputs) = machines().into_iter().find(|machine| machine.0 == "sampled-spline").unwrap();
    let figure = Figure::read(&all(&netlist, &outputs).svg);
    let memories: Vec<_> = figure.frames.iter().filter(|frame| frame.class == "memory").collect();
    assert_eq!(memories.len(), netlist.memories.len());
    for frame in memories {
        let texts = figure.texts_in(frame);
        let has = |from: &str, to: &str| texts.iter().any(|text| text.starts_with(from) && text.contains(to));
        for port in [("write", "data"), ("write", "address"), ("read", "address")] {
            assert!(has(port.0, port.1), "{port:?}: {texts:?}");
        }
        assert!(!texts.iter().any(|text| text.starts_with("else")), "{texts:?}");
    }
}
