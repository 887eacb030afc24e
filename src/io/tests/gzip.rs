//! Gzip'd files, and the limit of file sizes.

use super::super::gzip as io_gzip;
use super::*;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn limited(bytes: &[u8], max_bytes: u64) -> Result<Loaded, Error> {
    parse(Format::Off, bytes, &ReadOptions { max_bytes, ..ReadOptions::default() })
}

const TRIANGLE: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn every_format_comes_back_and_files_of_one_mesh_are_the_same() {
    let mesh = Mesh::new(Three, vec![0., 0., 0., 1., 0., 0., 0., 1., 0.5], vec![0, 1, 2]).unwrap();
    for (format, name) in ALL.into_iter().zip(["a.off.gz", "a.OBJ.GZ", "a.ply.gz", "a.stl.gz"]) {
        let bytes = to_file_bytes(name, &mesh).unwrap();
        assert!(bytes.starts_with(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0]));
        assert_eq!(parsed(format, &bytes).unwrap().mesh, mesh);
        assert_eq!(to_file_bytes(name, &mesh).unwrap(), bytes);
        assert_eq!(to_file_bytes(&name[..5], &mesh).unwrap(), to_bytes(format, &mesh).unwrap());
        for length in 2..bytes.len() {
            let error = parsed(format, &bytes[..length]).unwrap_err().to_string();
            assert!(error.contains("the gzip'd file is cut off"), "{error}");
        }
    }
}

#[test]
fn members_are_joined() {
    let (head, tail) = TRIANGLE.as_bytes().split_at(9);
    let members = [packed(head), packed(b""), packed(tail)].concat();
    assert_eq!(off(members).unwrap(), off(TRIANGLE).unwrap());
}

#[test]
fn a_damaged_file_is_refused() {
    let whole = packed(TRIANGLE.as_bytes());
    let end = whole.len();
    let changed = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x55;
        bytes
    };
    let sum = "corrupt gzip stream does not have a matching checksum";
    refused(off(changed(end - 5)), &format!("byte {end}: the gzip'd file is damaged ({sum})"));
    refused(off(changed(2)), "byte 10: the gzip'd file is damaged (invalid gzip header)");
    refused(
        off([&whole, b"garbage, and more of it".as_slice()].concat()),
        &format!("byte {end}: 23 other bytes follow the gzip'd data; cut them off"),
    );
    refused(
        off(&whole[..end - 1]),
        &format!("byte {}: the gzip'd file is cut off (unexpected end of file)", end - 1),
    );
    refused(off(packed(b"")), "line 1: the file is empty");
}

/// gzip(1) also accepts zeros as padding, and ignores other bytes with a warning.
#[test]
fn zeros_may_follow_and_nothing_else() {
    let whole = packed(TRIANGLE.as_bytes());
    let end = whole.len();
    for zeros in [1, 2, 100, 10_000] {
        assert_eq!(off([&*whole, &vec![0; zeros]].concat()).unwrap(), off(TRIANGLE).unwrap());
    }
    for (more, count) in [(&b"abc"[..], 3), (b"\x1f", 1), (b"\0\0a\0", 4), (b"\0\x1f\x8b\x08", 4)] {
        let message = format!("byte {end}: {count} other bytes follow the gzip'd data; cut them off");
        refused(off([&whole, more].concat()), &message);
    }
    let cut = [&*whole, &whole[..end - 1]].concat();
    refused(off(&cut), &format!("byte {}: the gzip'd file is cut off (unexpected end of file)", cut.len()));
}

#[test]
fn no_file_is_larger_than_the_limit() {
    let text = TRIANGLE.to_owned() + &" ".repeat(100);
    let length = text.len() as u64;
    for bytes in [text.as_bytes(), &packed(text.as_bytes())] {
        limited(bytes, length).unwrap();
        let message = format!(
            "the file has more than {} bytes, packed or unpacked; max_bytes sets the limit",
            length - 1
        );
        refused(limited(bytes, length - 1), &message);
        limited(bytes, u64::MAX).unwrap();
        assert!(matches!(limited(bytes, 0), Err(Error::FileTooLarge { limit: 0, .. })));
    }
    // A zip bomb: unpacked, it is a thousand times as large.
    let bomb = packed(&vec![b' '; 1 << 24]);
    assert!(bomb.len() < 1 << 15);
    assert!(matches!(limited(&bomb, 1 << 20), Err(Error::FileTooLarge { .. })));
    let mut options = ReadOptions::default();
    for length in [0, 1, (1 << 16) - 1, 1 << 16, (1 << 16) + 1, (1 << 17) + 1, 1 << 20] {
        options.max_bytes = length as u64;
        let unpacked = io_gzip::unpack(&packed(&vec![7; length]), &options).unwrap();
        assert_eq!((unpacked.len(), unpacked.capacity() <= length + 1), (length, true));
    }
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn a_file_on_disk_is_as_its_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply.gz");
    let mesh = Mesh::new(Three, vec![0., 0.5, 1.], vec![]).unwrap();
    write(&path, &mesh).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), to_file_bytes(&path, &mesh).unwrap());
    assert_eq!(read(&path, &ReadOptions::default()).unwrap(), mesh);
    let options = ReadOptions { max_bytes: 10, ..ReadOptions::default() };
    assert!(matches!(read(&path, &options), Err(Error::FileTooLarge { limit: 10, .. })));
    // A gzip'd file is also read if its name has no .gz.
    let other = folder.path().join("a.ply");
    std::fs::rename(&path, &other).unwrap();
    assert_eq!(read(&other, &ReadOptions::default()).unwrap(), mesh);
}
