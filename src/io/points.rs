//! Points as text. CSV: one point per line, in columns that a first line may name. XYZ: one point per line, with white
//! space between its numbers. Both have two or three numbers per point; further columns are dropped.

use super::coordinates::{self, Float, Reading};
use super::options::Coordinates;
use super::parsed::{CutFaces, Dropped, Parsed};
use super::text::{Lines, Tokens, float, quoted, without_comment};
use crate::{Error, Positions};
use csv::{ByteRecord, Position, ReaderBuilder, Trim};

/// The names of columns that have coordinates, in lower case.
const NAMES: [&[&str]; 3] = [
    &["x", "lon", "lng", "long", "longitude", "easting", "east"],
    &["y", "lat", "latitude", "northing", "north"],
    &["z", "height", "elevation", "elev", "ele", "altitude", "alt"],
];

const FURTHER: &str = "further columns";

/// Reads the bytes of a CSV file. The delimiter is the one of comma, semicolon and tab that its first line has most often.
pub(super) fn parse_csv(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    let first =
        Lines::new(bytes).find(|line| !without_comment(line).trim_ascii().is_empty()).unwrap_or_default();
    let count = |delimiter: &u8| first.iter().filter(|&b| b == delimiter).count();
    let delimiter = b"\t;,".iter().copied().max_by_key(count).unwrap_or(b',');
    parse(option, |row| {
        let mut reader = ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(Some(b'#'))
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .from_reader(bytes);
        let mut record = ByteRecord::new();
        // Reading from memory, and not as UTF-8, cannot fail.
        while reader.read_byte_record(&mut record).is_ok_and(|is_there| is_there) {
            let fields: Vec<_> = record.iter().collect();
            if fields != [b""] {
                row(record.position().map_or(1, |start| line_of(bytes, start)), &fields)?;
            }
        }
        Ok(())
    })
}

/// The line of a record. Its position is that of the empty lines and comments before it.
fn line_of(bytes: &[u8], start: &Position) -> usize {
    let rest = bytes.get(start.byte() as usize..).unwrap_or_default();
    let mut lines = Lines { rest, number: start.line() as usize - 1 };
    while lines.next().is_some_and(|line| line.is_empty() || line.starts_with(b"#")) {}
    lines.number()
}

/// Reads the bytes of an XYZ file. Commas and semicolons count as white space, and `//` begins a comment, too.
pub(super) fn parse_xyz(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    parse(option, |row| {
        let mut lines = Lines::new(bytes);
        while let Some(line) = lines.next() {
            let words = without_comment(line).split(|b| b",;".contains(b)).flat_map(Tokens);
            let words: Vec<_> = words.take_while(|word| !word.starts_with(b"//")).collect();
            if !words.is_empty() {
                row(lines.number(), &words)?;
            }
        }
        Ok(())
    })
}

/// Gets the number of a line and its fields.
type Row<'a> = &'a mut dyn FnMut(usize, &[&[u8]]) -> Result<(), Error>;

fn parse(option: Option<Coordinates>, rows: impl Fn(Row) -> Result<(), Error>) -> Result<Parsed, Error> {
    coordinates::read(option, |asks| read::<f32>(&rows, asks), || read::<f64>(&rows, false))
}

fn read<T: Float>(rows: impl Fn(Row) -> Result<(), Error>, asks: bool) -> Result<Parsed, Error>
where
    Positions: From<Vec<T>>,
{
    let mut points = Points::<T> { reading: Reading { asks, loses: false }, ..Points::default() };
    rows(&mut |line, fields| {
        points.add(fields).map_err(|message| Error::Parse { place: format!("line {line}"), message })
    })?;
    let Points { columns, positions, reading, dropped } = points;
    let (stride, loses) = (columns.len().max(2), reading.loses);
    Ok(Parsed { stride, positions: positions.into(), faces: CutFaces::default(), dropped, loses })
}

/// The points so far.
#[derive(Default)]
struct Points<T> {
    /// The columns of x, of y, and of z if there is one. None before the first line.
    columns: Vec<usize>,
    positions: Vec<T>,
    reading: Reading,
    dropped: Dropped,
}

impl<T: Float> Points<T> {
    /// Adds the point of a line. The first line may have names instead.
    fn add(&mut self, fields: &[&[u8]]) -> Result<(), String> {
        if self.columns.is_empty() {
            let has_names = !fields.iter().any(|field| float(field).is_some());
            self.columns = if has_names { named(fields)? } else { (0..fields.len().clamp(2, 3)).collect() };
            if fields.len() > self.columns.len() {
                self.dropped.note(FURTHER);
            }
            if has_names {
                return Ok(());
            }
        }
        for &column in &self.columns {
            let Some(field) = fields.get(column) else {
                return Err(format!("expected at least {} columns, found {}", column + 1, fields.len()));
            };
            self.positions.push(self.reading.coordinate(field)?);
        }
        Ok(())
    }
}

/// The columns of coordinates in a line of names.
fn named(fields: &[&[u8]]) -> Result<Vec<usize>, String> {
    let column = |names: &[&str]| {
        fields.iter().position(|field| names.iter().any(|name| field.eq_ignore_ascii_case(name.as_bytes())))
    };
    match NAMES.map(column) {
        [Some(x), Some(y), z] => Ok([x, y].into_iter().chain(z).collect()),
        _ => {
            let names: Vec<_> = fields.iter().map(|field| quoted(field)).collect();
            Err(format!(
                "no columns are named x and y, lon and lat, or easting and northing; found {}",
                names.join(", ")
            ))
        }
    }
}
