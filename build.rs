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
    for folder in ["shared", "webgpu"] {
        for entry in fs::read_dir(format!("shaders/{folder}"))? {
            let entry = entry?;
            texts.insert(PathBuf::from(folder).join(entry.file_name()), fs::read_to_string(entry.path())?);
        }
        fs::create_dir_all(PathBuf::from(&env::var("OUT_DIR")?).join(folder))?;
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

/// Gives every name that the shaders declare a short one, the most frequent the shortest: one of one letter where a
/// function declares it for itself, else one of two, the same in all shaders. No two that meet get the same, and none
/// gets one that is there already: so each still means what it did.
fn shorten<K: Ord>(texts: &mut BTreeMap<K, String>) {
    for text in texts.values_mut() {
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
        *text = lines.collect::<Vec<_>>().join("\n");
    }
    let mut sources: Vec<_> = texts.values().map(|text| tokens(text)).collect();
    sources.iter_mut().for_each(|tokens| shorten_locals(tokens));
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for token in sources.iter().flatten().filter(|token| token.local.is_none()) {
        *counts.entry(token.text).or_default() += 1;
    }
    let names = Names::of(&sources);
    let (mut ours, theirs): (Vec<_>, Vec<_>) = counts.into_iter().partition(|(name, _)| names.has(name));
    ours.sort_by_key(|&(_, count)| Reverse(count));
    let free = pairs().filter(|short| theirs.iter().all(|(name, _)| name != short));
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
    /// The short name, of what a function declares for itself.
    local: Option<char>,
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.trim_start().chars().next() {
        let trimmed = rest.trim_start();
        let end = trimmed.find(|c| !is_of_word(c)).unwrap_or(trimmed.len()).max(first.len_utf8());
        tokens.push(Token { text: &trimmed[..end], is_apart: trimmed.len() < rest.len(), local: None });
        rest = &trimmed[end..];
    }
    tokens
}

fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Single letters for the parameters and variables of each function, which has to have no more of them than there are.
fn shorten_locals(tokens: &mut [Token]) {
    let mut rest = tokens;
    while let Some(start) = rest.iter().position(|token| token.text == "fn") {
        let mut depth = 0;
        let closes = |token: &Token| {
            depth += i32::from(token.text == "{") - i32::from(token.text == "}");
            token.text == "}" && depth == 0
        };
        let end = rest[start..].iter().position(closes).map_or(rest.len(), |length| start + length + 1);
        let (function, behind) = std::mem::take(&mut rest)[start..].split_at_mut(end - start);
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for pair in function.windows(2) {
            match (pair[0].text, pair[1].text) {
                ("let" | "var" | "const", name) | (name, ":") => counts.insert(name, 0),
                _ => None,
            };
        }
        // What follows a point is a member.
        let places: Vec<_> = (1..function.len()).filter(|&i| function[i - 1].text != ".").collect();
        for &i in &places {
            counts.entry(function[i].text).and_modify(|count| *count += 1);
        }
        let mut names: Vec<_> = counts.into_iter().collect();
        names.sort_by_key(|&(_, count)| Reverse(count));
        assert!(names.len() <= letters().count(), "a function of the shaders with {} names", names.len());
        let short: HashMap<_, _> = names.into_iter().map(|(name, _)| name).zip(letters()).collect();
        for i in places {
            function[i].local = short.get(function[i].text).copied();
        }
        rest = behind;
    }
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

fn letters() -> impl Iterator<Item = char> {
    ('a'..='z').chain('A'..='Z')
}

/// `aA`, `bA`, …: a second character that is no small letter makes no word of WGSL.
fn pairs() -> impl Iterator<Item = String> {
    let seconds = ('A'..='Z').chain('0'..='9');
    seconds.flat_map(|second| letters().map(move |first| format!("{first}{second}")))
}

/// Leaves white space only where two words or two operators would become one, and a comma only between two things.
fn write(tokens: &[Token], short: &HashMap<&str, String>) -> String {
    let mut text = String::new();
    for token in tokens {
        if text.ends_with(',') && matches!(token.text, ")" | "}") {
            text.pop();
        }
        let joins = |c: char, d: char| is_of_word(c) && is_of_word(d) || is_operator(c) && is_operator(d);
        if let (Some(last), Some(first)) = (text.chars().next_back(), token.text.chars().next())
            && token.is_apart
            && joins(last, first)
        {
            text.push(' ');
        }
        match token.local {
            Some(letter) => text.push(letter),
            None => text.push_str(short.get(token.text).map_or(token.text, String::as_str)),
        }
    }
    text
}

fn is_operator(c: char) -> bool {
    "+-*/%&|^<>=!".contains(c)
}
