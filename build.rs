//! Makes the text of the shaders smaller for browsers, which download it: no comments, hardly any white space, and short
//! names. Elsewhere it stays as it is, so that what a driver says of it can be read.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=shaders");
    let mut texts = BTreeMap::new();
    for entry in fs::read_dir("shaders")? {
        let entry = entry?;
        texts.insert(entry.file_name(), fs::read_to_string(entry.path())?);
    }
    if env::var("CARGO_CFG_TARGET_ARCH")? == "wasm32" {
        shorten(&mut texts);
    }
    let to = PathBuf::from(env::var("OUT_DIR")?);
    for (name, text) in texts {
        fs::write(to.join(name), text)?;
    }
    Ok(())
}

/// Gives every name that the shaders declare the same short one in all of them, the most frequent the shortest. No two
/// get the same, and none gets one that is there already: so each still means what it did.
fn shorten<K: Ord>(texts: &mut BTreeMap<K, String>) {
    for text in texts.values_mut() {
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
        *text = lines.collect::<Vec<_>>().join("\n");
    }
    let sources: Vec<_> = texts.values().map(|text| tokens(text)).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for token in sources.iter().flatten() {
        *counts.entry(token.text).or_default() += 1;
    }
    let names = Names::of(&sources);
    let (mut ours, theirs): (Vec<_>, Vec<_>) = counts.into_iter().partition(|(name, _)| names.has(name));
    ours.sort_by_key(|&(_, count)| Reverse(count));
    let free = short_names().filter(|short| theirs.iter().all(|(name, _)| name != short));
    let short: HashMap<_, _> = ours.into_iter().map(|(name, _)| name).zip(free).collect();
    let written: Vec<_> = sources.iter().map(|tokens| write(tokens, &short)).collect();
    for (text, short) in texts.values_mut().zip(written) {
        *text = short;
    }
}

/// A word, or any other character by itself.
struct Token<'a> {
    text: &'a str,
    /// Whether white space is before it.
    is_apart: bool,
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.trim_start().chars().next() {
        let trimmed = rest.trim_start();
        let end = trimmed.find(|c| !is_of_word(c)).unwrap_or(trimmed.len()).max(first.len_utf8());
        tokens.push(Token { text: &trimmed[..end], is_apart: trimmed.len() < rest.len() });
        rest = &trimmed[end..];
    }
    tokens
}

fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Names of functions and types; of variables, constants, parameters and members; and those that have to stay.
#[derive(Default)]
struct Names<'a> {
    callable: HashSet<&'a str>,
    others: HashSet<&'a str>,
    called: HashSet<&'a str>,
    kept: HashSet<&'a str>,
}

impl<'a> Names<'a> {
    fn of(sources: &[Vec<Token<'a>>]) -> Self {
        let mut names = Self { kept: HashSet::from(["default"]), ..Self::default() };
        for tokens in sources {
            let text = |i: usize| tokens.get(i).map_or("", |token| token.text);
            for i in 0..tokens.len() {
                match (text(i), text(i + 1), text(i + 2)) {
                    // An entry point, which the host names: its attributes end with `)`.
                    (")", "fn", name) | ("@" | "override", name, _) | ("builtin", "(", name) => {
                        names.kept.insert(name)
                    }
                    ("fn" | "struct" | "alias", name, _) => names.callable.insert(name),
                    ("const" | "let" | "var", name, _) | (name, ":", _) => names.others.insert(name),
                    // `var<storage, read> twins`
                    (">", name, ":") => names.others.insert(name),
                    (name, "(", _) => names.called.insert(name),
                    _ => false,
                };
            }
        }
        names
    }

    /// Whether the shaders declare it, and nobody else: no function of WGSL has the name, and no component of a vector.
    fn has(&self, name: &str) -> bool {
        let is_ours =
            self.callable.contains(name) || self.others.contains(name) && !self.called.contains(name);
        let is_word = name.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_component = ["xyzw", "rgba"].iter().any(|letters| name.chars().all(|c| letters.contains(c)));
        is_ours && is_word && !is_component && !self.kept.contains(name)
    }
}

/// `a`, `b`, … `Z`, `aA`, `bA`, …: a second character that is no small letter makes no word of WGSL.
fn short_names() -> impl Iterator<Item = String> {
    let letters = || ('a'..='z').chain('A'..='Z');
    let seconds = ('A'..='Z').chain('0'..='9');
    let pairs = seconds.flat_map(move |second| letters().map(move |first| format!("{first}{second}")));
    letters().map(String::from).chain(pairs)
}

/// Leaves white space only where two words or two operators would become one.
fn write(tokens: &[Token], short: &HashMap<&str, String>) -> String {
    let mut text = String::new();
    for token in tokens {
        let joins = |c: char, d: char| is_of_word(c) && is_of_word(d) || is_operator(c) && is_operator(d);
        if let (Some(last), Some(first)) = (text.chars().next_back(), token.text.chars().next())
            && token.is_apart
            && joins(last, first)
        {
            text.push(' ');
        }
        text.push_str(short.get(token.text).map_or(token.text, String::as_str));
    }
    text
}

fn is_operator(c: char) -> bool {
    "+-*/%&|^<>=!".contains(c)
}
