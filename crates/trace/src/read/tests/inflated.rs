//! FST files that inflate.

use super::{COUNTER_FST, Wave, error};

fn number(mut number: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number >= 0x80 {
        bytes.push(0x80 | number.to_le_bytes()[0]);
        number >>= 7;
    }
    bytes.push(number.to_le_bytes()[0]);
    bytes
}

fn block(kind: u8, content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u64 + 8).to_be_bytes();
    [&[kind], length.as_slice(), content].concat()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, 9)
}

/// An FST of `handles` one-bit signals that all share one chain of `changes` changes.
fn fst(handles: usize, changes: usize) -> Vec<u8> {
    let header = &COUNTER_FST[..330];
    let sizes = vec![1; handles];
    let packed = zlib(&sizes);
    let all = handles as u64;
    let geometry = [&all.to_be_bytes(), &all.to_be_bytes(), packed.as_slice()].concat();
    let mut names = Vec::new();
    (0..handles).for_each(|_| names.extend_from_slice(b"\x10\0q\0\x01\0"));
    let mut hierarchy = (names.len() as u64).to_be_bytes().to_vec();
    hierarchy.extend([0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255]);
    hierarchy.extend(miniz_oxide::deflate::compress_to_vec(&names, 9));

    // Toggles at every time: a step of one time and the value, in one byte.
    let chain: Vec<u8> = (0..changes).map(|change| if change % 2 == 0 { 4 } else { 6 }).collect();
    let chain = [number(changes as u64), zlib(&chain)].concat();
    let mut changes_block = [0u64.to_be_bytes(), (changes as u64).to_be_bytes(), 0u64.to_be_bytes()].concat();
    let frame = zlib(&vec![b'0'; handles]);
    changes_block.extend([number(all), number(frame.len() as u64), number(all)].concat());
    changes_block.extend(frame);
    changes_block.extend(number(all));
    changes_block.push(b'Z');
    changes_block.extend(&chain);
    // The first handle has a chain one byte further on, the next ones are aliases of it, and all others have none.
    let mut places = vec![1 << 1 | 1];
    let aliases = (all - 1).min(10_000);
    (0..aliases).for_each(|_| places.push(0x7f));
    places.extend(number((all - 1 - aliases) << 1));
    changes_block.extend(&places);
    changes_block.extend((places.len() as u64).to_be_bytes());
    let times = vec![1u8; changes + 1];
    let packed = zlib(&times);
    changes_block.extend(&packed);
    changes_block.extend([times.len(), packed.len(), times.len()].map(|size| (size as u64).to_be_bytes()).concat());
    [header, &block(8, &changes_block), &block(3, &geometry), &block(4, &hierarchy)].concat()
}

#[test]
fn a_file_that_inflates_too_much_is_refused_by_its_limit() {
    let small = Wave::from_bytes(fst(3, 1000)).expect("an FST");
    assert_eq!((small.signals().len(), small.times().len()), (3, 1002));
    for (handles, changes) in [(1, 8_000_000), (4000, 100_000), (3_000_000, 1)] {
        let bytes = fst(handles, changes);
        assert!(bytes.len() < 200_000, "{}", bytes.len());
        let refused = error(bytes);
        assert!(refused.contains("take more than 6"), "{handles} handles, {changes} changes: {refused}");
    }
}

#[test]
fn an_fst_in_gzip_is_read_and_one_that_inflates_too_much_is_refused() {
    let wrapped = |bytes: &[u8], claimed: u64| {
        let packed = miniz_oxide::deflate::compress_to_vec(bytes, 9);
        let content = [&claimed.to_be_bytes(), [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255].as_slice(), &packed].concat();
        block(254, &content)
    };
    let wave = Wave::from_bytes(wrapped(COUNTER_FST, COUNTER_FST.len() as u64)).expect("an FST");
    assert_eq!(wave.signals().len(), 4);
    let zeros = vec![0; 100 << 20];
    assert!(error(wrapped(&zeros, 100 << 20)).contains("the FST that it holds in gzip take more than"));
    assert!(error(wrapped(&zeros, 1 << 20)).contains("is broken or cut off"));
    assert!(error(wrapped(COUNTER_FST, u64::MAX)).contains("take more than"));
    assert!(error(wrapped(&wrapped(COUNTER_FST, 100), 100)).contains("broken"));
}

#[test]
fn a_file_that_lacks_blocks_of_changes_is_cut_off() {
    let whole = fst(3, 8);
    assert_eq!(whole[65..73], 1u64.to_be_bytes());
    assert!(Wave::from_bytes(whole.clone()).is_ok());
    // As long as it is written the header names no block.
    let with = |blocks: u64| [&whole[..65], &blocks.to_be_bytes(), &whole[73..]].concat();
    assert!(Wave::from_bytes(with(0)).is_ok());
    assert!(error(with(2)).contains(&format!("byte {}: the file ends inside its blocks of changes", whole.len())));
}
