//! Pictures in a terminal: which of the protocols for them it understands, as its environment says, and what is written to show one.

use std::collections::HashMap;
use std::env;
use std::io::{self, IsTerminal, Write};

use base64::prelude::{BASE64_STANDARD, Engine};
use clap::{Args, ValueEnum};

use crate::render::{Picture, RenderError};

/// The option for pictures in the terminal.
#[derive(Args, Clone, Copy)]
pub(crate) struct InlineArgs {
    /// Show a picture of the shape in the terminal, before the report. By default it is shown if no file is written and
    /// the terminal is known to display pictures.
    #[arg(
        long = "picture",
        value_enum,
        value_name = "HOW",
        default_value = "auto",
        help_heading = "Pictures (.png)"
    )]
    inline: Inline,
}

/// Whether a picture is shown in the terminal, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Inline {
    /// Where nothing is written to files, and the terminal is one that is known to show pictures.
    Auto,
    /// Not at all.
    Never,
    /// By the protocol of kitty, which Ghostty, Konsole and others have, too.
    Kitty,
    /// By that of iTerm2, which mintty has, too.
    Iterm2,
    /// As sixels: foot, mlterm, Windows Terminal, xterm -ti vt340.
    Sixel,
}

/// How a picture is written to a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Protocol {
    Kitty,
    Iterm2,
    Sixel,
}

impl InlineArgs {
    /// Whether the user wants a picture wherever output goes.
    pub(crate) fn is_asked_for(self) -> bool {
        !matches!(self.inline, Inline::Auto | Inline::Never)
    }

    /// The protocol to show a picture by, or `None` to show none. `is_free` says whether nothing else is written.
    pub(crate) fn protocol(self, is_free: bool) -> Option<Protocol> {
        match self.inline {
            Inline::Auto if is_free && io::stdout().is_terminal() => {
                Protocol::of(|name| env::var(name).ok())
            }
            Inline::Auto | Inline::Never => None,
            Inline::Kitty => Some(Protocol::Kitty),
            Inline::Iterm2 => Some(Protocol::Iterm2),
            Inline::Sixel => Some(Protocol::Sixel),
        }
    }
}

impl Protocol {
    /// The protocol of the terminal with these variables in its environment, if it is known to have one.
    fn of(variable: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let [term, program] =
            ["TERM", "TERM_PROGRAM"].map(|name| variable(name).unwrap_or_default());
        // These pass pictures on only where they are told to.
        let is_multiplexed = variable("TMUX").is_some()
            || ["screen", "tmux"].iter().any(|name| term.starts_with(name));
        let is_kitty = variable("KITTY_WINDOW_ID").is_some()
            || variable("KONSOLE_VERSION").is_some()
            || ["xterm-kitty", "xterm-ghostty"].contains(&term.as_str())
            || ["WezTerm", "ghostty"].contains(&program.as_str());
        let is_iterm2 = ["iTerm.app", "mintty"].contains(&program.as_str())
            || variable("LC_TERMINAL").is_some_and(|name| name == "iTerm2");
        let has_sixels = ["foot", "mlterm", "yaft"].iter().any(|name| term.starts_with(name))
            || term.contains("sixel");
        match () {
            () if is_multiplexed => None,
            () if is_kitty => Some(Self::Kitty),
            () if is_iterm2 => Some(Self::Iterm2),
            () if has_sixels => Some(Self::Sixel),
            () => None,
        }
    }

    /// What shows a picture in the terminal, and goes on in the next line.
    ///
    /// # Errors
    /// Out of memory.
    pub(crate) fn encode(self, picture: &Picture) -> Result<Vec<u8>, RenderError> {
        let mut out = Vec::new();
        match self {
            Self::Kitty => kitty(&picture.to_png()?, &mut out),
            Self::Iterm2 => {
                let png = picture.to_png()?;
                let (length, text) = (png.len(), BASE64_STANDARD.encode(png));
                write!(out, "\x1b]1337;File=inline=1;size={length}:{text}\x07")
            }
            Self::Sixel => sixel(picture, &mut out),
        }
        .expect("memory takes all bytes");
        out.push(b'\n');
        Ok(out)
    }
}

/// The kitty graphics protocol: PNG in base64, in parts of 4096 bytes of which all but the last say that there are more.
fn kitty(png: &[u8], out: &mut impl Write) -> io::Result<()> {
    let text = BASE64_STANDARD.encode(png);
    let parts = text.as_bytes().chunks(4096);
    let last = parts.len() - 1;
    for (k, part) in parts.enumerate() {
        let how = if k == 0 { "a=T,f=100," } else { "" };
        write!(out, "\x1b_G{how}m={};", u8::from(k < last))?;
        out.write_all(part)?;
        out.write_all(b"\x1b\\")?;
    }
    Ok(())
}

/// Colours of a sixel picture.
const COLOURS: usize = 256;

/// Sixels: bands six pixels high, in which each colour has a row of characters, whose bits are the pixels below each other. Colours are rounded
/// to 5 bits a channel; of those that are too many, the rarest become the nearest of the others.
fn sixel(picture: &Picture, out: &mut impl Write) -> io::Result<()> {
    let (width, height) = (picture.size().width() as usize, picture.size().height() as usize);
    let rounded = |[r, g, b, _]: [u8; 4]| [r, g, b].map(|channel| channel >> 3);
    let mut counts = HashMap::<[u8; 3], usize>::new();
    picture.pixels().iter().for_each(|&pixel| *counts.entry(rounded(pixel)).or_default() += 1);
    let mut colours: Vec<([u8; 3], usize)> = counts.into_iter().collect();
    colours.sort_unstable_by_key(|&(colour, count)| (usize::MAX - count, colour));
    let palette: Vec<[u8; 3]> = colours.iter().take(COLOURS).map(|&(colour, _)| colour).collect();
    let distance = |a: [u8; 3], b: [u8; 3]| -> u32 {
        (0..3).map(|k| u32::from(a[k].abs_diff(b[k])).pow(2)).sum()
    };
    let nearest = |colour| (0..palette.len()).min_by_key(|&k| distance(palette[k], colour));
    let numbers: HashMap<[u8; 3], usize> =
        colours.iter().filter_map(|&(colour, _)| Some((colour, nearest(colour)?))).collect();
    // Pixels are square.
    write!(out, "\x1bPq\"1;1;{width};{height}")?;
    for (k, colour) in palette.iter().enumerate() {
        let [r, g, b] = colour.map(|channel| u32::from(channel) * 100 / 31);
        write!(out, "#{k};2;{r};{g};{b}")?;
    }
    for band in picture.pixels().chunks(6 * width) {
        let mut rows = HashMap::<usize, Vec<u8>>::new();
        for (at, &pixel) in band.iter().enumerate() {
            let row = rows.entry(numbers[&rounded(pixel)]).or_insert_with(|| vec![0; width]);
            row[at % width] |= 1 << (at / width);
        }
        let mut rows: Vec<(usize, Vec<u8>)> = rows.into_iter().collect();
        rows.sort_unstable();
        for (number, row) in rows {
            write!(out, "#{number}")?;
            for run in row.chunk_by(|a, b| a == b) {
                write!(out, "!{}{}", run.len(), char::from(run[0] + b'?'))?;
            }
            // Back to the left end of the band.
            write!(out, "$")?;
        }
        // To the next band.
        write!(out, "-")?;
    }
    write!(out, "\x1b\\")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_are_known_by_their_environment() {
        let of = |variables: &[(&str, &str)]| {
            let find = |name: &str| variables.iter().find(|(known, _)| *known == name);
            Protocol::of(|name| find(name).map(|(_, value)| (*value).to_owned()))
        };
        assert_eq!(of(&[("TERM", "xterm-kitty"), ("KITTY_WINDOW_ID", "1")]), Some(Protocol::Kitty));
        assert_eq!(
            of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "WezTerm")]),
            Some(Protocol::Kitty)
        );
        assert_eq!(of(&[("TERM_PROGRAM", "iTerm.app")]), Some(Protocol::Iterm2));
        assert_eq!(of(&[("LC_TERMINAL", "iTerm2")]), Some(Protocol::Iterm2));
        assert_eq!(of(&[("TERM", "foot-extra")]), Some(Protocol::Sixel));
        assert_eq!(of(&[("TERM", "xterm-256color")]), None);
        assert_eq!(of(&[("TERM", "tmux-256color"), ("KITTY_WINDOW_ID", "1")]), None);
        assert_eq!(of(&[("TERM", "xterm-kitty"), ("TMUX", "/tmp/tmux")]), None);
        assert_eq!(of(&[]), None);
    }
}
