//! Parts of a sweep in Parquet of which bytes were changed.

use std::fs;

use super::Folder;

#[test]
fn a_part_with_a_changed_byte_is_merged_or_refused_and_never_a_crash() {
    let folder = Folder::new();
    for (part, name) in [("1/2", "p.parquet"), ("2/2", "r.parquet")] {
        folder.good(&format!("sweep dda-line --to-grid 1..3x1..2 --shard {part} --parquet {name}"));
    }
    folder.good("sweep merge out.parquet p.parquet r.parquet");
    let whole = fs::read(folder.path("p.parquet")).unwrap();
    let merged = fs::read(folder.path("out.parquet")).unwrap();
    for at in (0..whole.len()).step_by(whole.len().div_ceil(150)) {
        for flip in [0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            fs::write(folder.path("q.parquet"), bytes).unwrap();
            let ran = folder.run("sweep merge out.parquet q.parquet r.parquet");
            let named = ran.err.starts_with("stepwave: ") && ran.err.contains("q.parquet");
            assert!(ran.code == 0 || (ran.code == 2 && named), "byte {at}: {ran:?}");
            // A byte that changes no row changes nothing in what is merged; a refusal leaves the file before.
            assert!(fs::read(folder.path("out.parquet")).unwrap() == merged, "byte {at}: {ran:?}");
        }
    }
}
