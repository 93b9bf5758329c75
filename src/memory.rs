//! How much memory the program may take. Whoever is about to take much asks first, so that what cannot be had is an error
//! and not the end of the program (`--max-memory`).

use std::fmt;
use std::sync::OnceLock;

/// What stays free for others: this part of what the machine has free, and this many bytes at least.
const RESERVE_PART: u64 = 16;
const RESERVE: u64 = 256 << 20;

/// The most bytes that the program may have.
static LIMIT: OnceLock<u64> = OnceLock::new();

/// Sets the limit, in bytes; the first call counts, and none that comes after the first `check`.
pub fn set_limit(bytes: u64) {
    let _ = LIMIT.set(bytes);
}

/// The most bytes that the program may have: what was set, or what the machine has free at the first call, less a reserve.
/// Without bounds where the system does not tell (Linux does).
fn limit() -> u64 {
    *LIMIT.get_or_init(|| match available() {
        Some(free) => own().saturating_add(free.saturating_sub(RESERVE.max(free / RESERVE_PART))),
        None => u64::MAX,
    })
}

/// Bytes that the program has; 0 where the system does not tell.
fn own() -> u64 {
    std::fs::read_to_string("/proc/self/status").ok().and_then(|text| kilobytes(&text, "VmRSS:")).unwrap_or(0)
}

/// Bytes that the machine has free, or the container.
fn available() -> Option<u64> {
    let machine = kilobytes(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    let number = |file: &str| -> Option<u64> {
        std::fs::read_to_string(format!("/sys/fs/cgroup/memory.{file}")).ok()?.trim().parse().ok()
    };
    let container = number("max").zip(number("current")).map(|(most, now)| most.saturating_sub(now));
    Some(machine.min(container.unwrap_or(u64::MAX)))
}

/// The bytes of the line that begins with `name`, which gives them in kB.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|count| count * 1024)
}

/// More memory than there is: exit code 75.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} takes {}; {} of {} are left (--max-memory)", Size(*.bytes), Size(.limit.saturating_sub(*.own)), Size(*.limit))]
pub struct Shortage {
    /// Such as "the film".
    pub what: String,
    pub bytes: u64,
    /// The most that the program may have, and what it has.
    pub limit: u64,
    pub own: u64,
}

/// Why what is to be read is refused: it is not as it must be, or takes more memory than there is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    Bad(String),
    Memory(Shortage),
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self::Bad(message)
    }
}

/// An error unless the program may take `bytes` bytes for `what` beside those that it has.
pub fn check(what: &str, bytes: u64) -> Result<(), Shortage> {
    against(what, bytes, limit(), own())
}

fn against(what: &str, bytes: u64, limit: u64, own: u64) -> Result<(), Shortage> {
    if bytes > limit.saturating_sub(own) {
        return Err(Shortage { what: what.to_owned(), bytes, limit, own });
    }
    Ok(())
}

/// Bytes as people read them.
struct Size(u64);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = UNITS.iter().rev().find(|(_, bytes)| self.0 >= *bytes);
        match unit {
            Some((name, bytes)) => write!(f, "{:.1} {name}iB", self.0 as f64 / *bytes as f64),
            None => write!(f, "{} bytes", self.0),
        }
    }
}

const UNITS: [(&str, u64); 4] = [("K", 1 << 10), ("M", 1 << 20), ("G", 1 << 30), ("T", 1 << 40)];

/// Reads a size: `900M`, `1.5G`, `4096`; K, M, G and T are powers of 1024.
pub fn parse_size(text: &str) -> Result<u64, String> {
    let unit = UNITS.iter().find_map(|(name, bytes)| Some((text.strip_suffix(name)?, *bytes)));
    let (number, unit) = unit.unwrap_or((text, 1));
    let bytes = number.parse::<f64>().ok().map(|number| number * unit as f64);
    match bytes {
        Some(bytes) if bytes >= 1.0 && bytes < u64::MAX as f64 => Ok(bytes as u64),
        _ => Err("expected a size in bytes, as in 900M or 1.5G".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_can_be_had_and_no_more() {
        assert_eq!(against("the film", 600, 1000, 400), Ok(()));
        let short = against("the film", 3 << 30, 2 << 30, 512 << 20).unwrap_err();
        assert_eq!(short.to_string(), "the film takes 3.0 GiB; 1.5 GiB of 2.0 GiB are left (--max-memory)");
        // A limit below what the program has already.
        assert!(against("the film", 1, 1000, 4000).is_err());
        assert_eq!(against("nothing", 0, 1000, 4000), Ok(()));
    }

    #[test]
    fn sizes_are_read_with_their_unit() {
        for (text, bytes) in [("4096", 4096), ("900M", 900 << 20), ("1.5G", 3 << 29), ("2T", 2 << 40), ("1K", 1024)] {
            assert_eq!(parse_size(text), Ok(bytes), "{text}");
        }
        for text in ["", "G", "-1G", "0", "nan", "1e40", "12X", "1 G", "inf"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn linux_tells_what_is_free_and_what_the_program_has() {
        if cfg!(target_os = "linux") {
            assert!(available().is_some_and(|bytes| bytes > 1 << 20) && own() > 1 << 20);
        }
        assert_eq!(kilobytes("VmPeak:\t  9 kB\nVmRSS:\t  12 kB\n", "VmRSS:"), Some(12 << 10));
    }
}
