//! Coordinates from text are those that the file shows.

use super::*;
use oorandom::Rand64;
use std::fmt::Write;

/// A file with this number, in each text format.
fn files(number: &str) -> [(Format, String); 4] {
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let rest = "1 0 0.5";
    [
        (Format::Off, format!("OFF 3 1 0\n0 {number} 0\n{rest}\n0 1 0\n3 0 1 2\n")),
        (Format::Obj, format!("v 0 {number} 0\nv {rest}\nv 0 1 0\nf 1 2 3\n")),
        (Format::Ply, format!("{head}0 {number} 0\n{rest}\n0 1 0\n3 0 1 2\n")),
        (
            Format::Stl,
            format!(
                "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 {number} 0\nvertex {rest}\nvertex 0 1 0\n\
                 endloop\nendfacet\nendsolid\n"
            ),
        ),
    ]
}

/// The bits of the coordinates of a file with this number, read with `option`, and its value.
fn read(number: &str, option: Option<Coordinates>) -> [(bool, f64); 4] {
    let options = ReadOptions { coordinates: option, ..ReadOptions::default() };
    files(number).map(|(format, text)| {
        let loaded =
            parse(format, text.as_bytes(), &options).unwrap_or_else(|error| panic!("{number}: {error}"));
        (loaded.mesh.positions().is_double(), loaded.mesh.point3(0).y)
    })
}

#[test]
fn a_number_that_singles_show_is_a_single() {
    for number in [
        "0",
        "-0",
        "1",
        "0.1",
        "0.10000000000",
        "123456",
        "0.123456",
        "1e-30",
        "1.5e38",
        "6.123234e-17",
        "16777216",
        // The digits of 32-bit floats: 6 to 9, all, and as a double.
        "3.14159",
        "3.1415927",
        "3.14159274",
        "3.1415927410125732421875",
        "3.1415927410125732",
        "1.17549435e-38",
        "12345.677734",
        "0.000012",
        // Halfway, some writers round to even, and others up.
        "100.007812",
        "100.007813",
        "0.00048828125e3",
        "100.0078125",
        "1234567.3",
        "1e-45",
        "+2.50e+01",
    ] {
        let single: f32 = number.parse().unwrap();
        assert_eq!(read(number, None), [(false, single.into()); 4], "{number}");
    }
}

#[test]
fn other_numbers_are_doubles() {
    for number in [
        "16777217",
        "4503123.08",
        "0.1234567891",
        "3.141592653589793",
        "1e39",
        "1e-46",
        "1.0000001e-40",
        "1e-300",
        "0.10000000001",
        "1234567.31",
    ] {
        let double: f64 = number.parse().unwrap();
        assert_eq!(read(number, None), [(true, double); 4], "{number}");
    }
}

#[test]
fn the_option_forces_a_width() {
    let found = read("3.141592653589793", Some(Coordinates::F32));
    assert_eq!(found, [(false, f64::from(std::f32::consts::PI)); 4]);
    assert_eq!(read("0.1", Some(Coordinates::F64)), [(true, 0.1); 4]);
    let narrow = ReadOptions { coordinates: Some(Coordinates::F32), ..ReadOptions::default() };
    let notes = |format, text: String| parse(format, text.as_bytes(), &narrow).unwrap().notes.len();
    for (format, text) in files("3.141592653589793") {
        assert_eq!(notes(format, text), 1);
    }
    for (format, text) in files("0.1") {
        assert_eq!(notes(format, text.clone()), 0);
        // The property of a PLY file can be a double.
        assert_eq!(notes(format, text.replace("float", "double")), usize::from(format == Format::Ply));
    }
    for (format, text) in files("1e39") {
        let message = parse(format, text.as_bytes(), &narrow).unwrap_err().to_string();
        assert!(message.contains("finite"), "{message}");
    }
}

#[test]
fn the_digits_of_the_file_are_those_of_its_coordinates() {
    let mut random = Rand64::new(4);
    let mut counts = [0; 2];
    for n in 0..20_000 {
        // A single or a double, of a size near 1 or of any size, with some digits.
        let bits = random.rand_u64();
        let near = f64::from_bits(0x3fe << 52 | bits >> 12) * 10f64.powi(random.rand_range(0..9) as i32 - 3);
        let any = f64::from(f32::from_bits(bits as u32));
        let double = if random.rand_float() < 0.8 || !any.is_finite() { near } else { any };
        let number = if random.rand_float() < 0.5 { f64::from(double as f32) } else { double };
        let digits = random.rand_range(0..18) as usize;
        let mut token = String::new();
        match n % 3 {
            0 => write!(token, "{number:.digits$}").unwrap(),
            1 => write!(token, "{number:.digits$e}").unwrap(),
            _ => write!(token, "{number}").unwrap(),
        }
        let value: f64 = token.parse().unwrap();
        let single: f32 = token.parse().unwrap();
        // The decimal number of as many digits that is next to the single.
        let plain = format!("{value:.17e}");
        let shown = (0..18).find(|digits| format!("{value:.digits$e}").parse() == Ok(value));
        let decimals = shown.unwrap_or(17);
        let is_same = single.is_finite() && format!("{single:.decimals$e}").parse() == Ok(value);
        let is_short = token.bytes().filter(u8::is_ascii_digit).count() <= 17;
        let (is_double, read) = self::read(&token, None)[n % 2];
        if is_short {
            assert_eq!(!is_double, is_same, "{token}: {plain}");
        }
        assert_eq!(read, if is_double { value } else { single.into() }, "{token}");
        counts[usize::from(is_double)] += 1;
    }
    assert!(counts.into_iter().all(|count| count > 5000), "{counts:?}");
}
