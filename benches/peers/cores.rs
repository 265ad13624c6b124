//! Cores that others wrote, as `stepwave import` takes them, each with a memory, a program and a checksum around it
//! (`cores/*.v`). All simulators get the same sources.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use stepwave::engine::EngineKind;
use stepwave::netlist::{Net, elaborate, text};

use crate::contender::shell;
use crate::measure::{Job, race};
use crate::sections::{Sizes, built, rate};
use crate::table::{Table, number, times};
use crate::unit::Unit;
use crate::{Fallible, own};

/// RISC-V: from x1 and x2 = 50 on `x1 += x2; x3 = x1 << 3; x4 = x3 ^ x1; x5 = x4 >> 2`, x5 to address 512, x4 to an
/// address outside of 1 GiB, the word at 512 to x6, `x1 += x6`, until x2 has counted to 0; and again, for ever.
const PROGRAM: [u32; 14] = [
    0x0000_0093,
    0x4000_03b7,
    0x0320_0113,
    0x0020_80b3,
    0x0030_9193,
    0x0011_c233,
    0x0022_5293,
    0x2050_2023,
    0x2043_a223,
    0x2000_2303,
    0x0060_80b3,
    0xfff1_0113,
    0xfc01_1ee3,
    0xfd5f_f06f,
];

/// Bytes of the memory of SERV.
const SERV_BYTES: usize = 8192;

/// A core: its name, the Verilog around it, its sources in the folder of the packages; a folder is all Verilog in it.
struct Core {
    name: &'static str,
    around: &'static str,
    sources: &'static [&'static str],
}

const CORES: [Core; 5] = [
    Core {
        name: "PicoRV32",
        around: include_str!("cores/picorv32.v"),
        sources: &["pythondata_cpu_picorv32/verilog/picorv32.v"],
    },
    Core {
        name: "VexRiscv, smallest",
        around: include_str!("cores/vexriscv.v"),
        sources: &["pythondata_cpu_vexriscv/verilog/VexRiscv_Min.v"],
    },
    Core {
        name: "VexRiscv",
        around: include_str!("cores/vexriscv.v"),
        sources: &["pythondata_cpu_vexriscv/verilog/VexRiscv.v"],
    },
    Core {
        name: "SERV",
        around: include_str!("cores/serv.v"),
        sources: &["pythondata_cpu_serv/verilog/rtl", "pythondata_cpu_serv/verilog/serving"],
    },
    Core { name: "step generator of litexcnc", around: include_str!("cores/stepgen.v"), sources: &["stepgen.v"] },
];

/// The test bench for Icarus: as the C++ mains of the others.
const BENCH: &str = "module bench;
    reg clk = 0, load = 1;
    wire done;
    wire [31:0] check;
    integer edges = 0;
    core dut(.clk(clk), .load(load), .clocks(32'dCLOCKS), .done(done), .check(check));
    initial forever begin
        #5 clk = 1;
        edges = edges + 1;
        #1 load = 0;
        if (done) begin
            $display(\"%0d %0d\", edges, check);
            $finish;
        end
        #4 clk = 0;
    end
endmodule
";

/// The folder that `.ci/import` leaves sources in.
pub(crate) fn folder() -> Fallible<PathBuf> {
    let folder = std::env::var_os("STEPWAVE_CORES").map_or_else(
        || Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap_or(Path::new(".")).join("import"),
        PathBuf::from,
    );
    if folder.join("cores/stepgen.v").exists() {
        return Ok(fs::canonicalize(folder)?);
    }
    let folder = folder.display();
    Err(format!("no sources of cores in {folder}: run .ci/import, or give its folder in STEPWAVE_CORES").into())
}

/// All Verilog of a core, and around it.
fn source(core: &Core, folder: &Path, dir: &Path) -> Fallible<String> {
    let python = fs::read_dir(folder.join("python/lib"))?.next().ok_or("no Python packages")??.path();
    let mut text = core.around.replace("\"program.", &format!("\"{}/program.", dir.display()));
    for source in core.sources {
        let packages = [folder.join("cores"), python.join("site-packages")];
        let path = packages.iter().map(|folder| folder.join(source)).find(|path| path.exists());
        let path = path.ok_or_else(|| format!("no {source} in {}: run .ci/import again", folder.display()))?;
        let mut files = vec![path.clone()];
        if path.is_dir() {
            files = fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<Fallible<_>>()?;
            files.retain(|file| file.extension().is_some_and(|extension| extension == "v"));
            files.sort();
        }
        for file in files {
            text += &fs::read_to_string(file)?;
        }
    }
    Ok(text)
}

/// A core as `stepwave import` made it.
pub(crate) fn imported(path: &Path) -> Fallible<Unit> {
    let design = elaborate(text::parse(&fs::read_to_string(path)?)?)?;
    let net = |name: &str| -> Fallible<Net> {
        let named = design.netlist().names.iter().find(|named| named.name == name && named.scope.index() == 0);
        Ok(named.ok_or_else(|| format!("no port {name}"))?.net)
    };
    let (load, done, check) = (net("load")?, net("done")?, net("check")?);
    let outputs = vec![done, check];
    Ok(Unit { design, outputs, strobes: vec![load], done, result: vec![(check, false)], source: None })
}

/// The words that let a core run for this many clocks.
pub(crate) fn block(unit: &Unit, clocks: u64) -> Vec<(Net, u64)> {
    let inputs = unit.design.inputs().iter().filter(|net| !unit.strobes.contains(net));
    inputs.map(|&net| (net, clocks)).collect()
}

/// Clocks of a run in Icarus.
const FEW: u64 = 1 << 15;

pub(crate) fn cores(sizes: &Sizes, dir: &Path) -> Fallible<String> {
    let folder = folder()?;
    let head = ["", "cells", "`compiled`", "`word`", "Verilator", "CXXRTL", "Icarus", "to Verilator", "to CXXRTL"];
    let title = format!("Cores that others wrote, 2^{} clocks: million clocks a second, one core", sizes.wave);
    let mut table = Table::new(&title, &head);
    for (index, core) in CORES.iter().enumerate() {
        let dir = dir.join(index.to_string());
        fs::create_dir_all(&dir)?;
        let unit = import(core, &folder, &dir)?;
        let clocks = 1 << sizes.wave;
        let blocks = unit.line(&block(&unit, clocks));
        let (verilator, cxxrtl) = built(&unit.rtl(), &dir, &blocks);
        // The word engine takes up to a minute, in which nothing disturbs it for long.
        let jobs = [
            own::core("compiled", EngineKind::Compiled, clocks, &dir)?,
            own::core("word", EngineKind::Word, clocks, &dir)?.rounds(1),
            verilator?.says(last),
            cxxrtl?.says(last),
        ];
        let mut runs = race(sizes.rounds, &jobs)?;
        // Icarus is slow: fewer clocks, and the same as of our own engine.
        let few = [icarus(&unit, &dir.join("icarus"))?, own::core("word", EngineKind::Word, FEW, &dir)?];
        runs.extend(race(1, &few)?.into_iter().take(1));
        let rates: Vec<f64> = runs.iter().map(|runs| rate(runs)).collect();
        let ratios = rates[2..4].iter().map(|peer| times(rates[0] / peer));
        let cells = unit.design.netlist().cells.len().to_string();
        table.row(core.name, [cells].into_iter().chain(rates.iter().copied().map(number)).chain(ratios));
    }
    Ok(table.text())
}

fn import(core: &Core, folder: &Path, dir: &Path) -> Fallible<Unit> {
    let words = PROGRAM.iter().map(|word| format!("{word:08x}\n")).collect::<String>();
    fs::write(dir.join("program.hex"), words)?;
    let mut bytes: Vec<u8> = PROGRAM.iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.resize(SERV_BYTES, 0);
    fs::write(dir.join("program.bytes"), bytes.iter().map(|byte| format!("{byte:02x}\n")).collect::<String>())?;
    let text = source(core, folder, dir)?;
    fs::write(dir.join("core.v"), &text)?;
    let mut command = Command::new(own::PROGRAM);
    // As the peers, without what no output depends on.
    command.args(["import", "core.v", "--top", "core", "--trim", "-o", "core.net"]).current_dir(dir);
    let output = command.output()?;
    if !output.status.success() {
        return Err(format!("{}: {}", core.name, String::from_utf8_lossy(&output.stderr)).into());
    }
    Ok(Unit { source: Some(text), ..imported(&dir.join("core.net"))? })
}

/// The last line that a simulator prints: SERV says first what it loads.
fn last(text: &str) -> Fallible<String> {
    Ok(text.lines().last().unwrap_or_default().to_owned())
}

/// A job of a core compiled already.
fn icarus(unit: &Unit, dir: &Path) -> Fallible<Job> {
    fs::create_dir_all(dir)?;
    fs::write(dir.join("model.v"), unit.verilog())?;
    fs::write(dir.join("bench.v"), BENCH.replace("CLOCKS", &FEW.to_string()))?;
    shell(dir, "iverilog -g2012 -s bench -o model.vvp bench.v model.v")?;
    Ok(Job::new("Icarus", dir, &["vvp", "-n", "model.vvp"]).says(last))
}
