//! Is a process still there? Its number alone does not tell: numbers are given again after its end, after a
//! boot, and in other namespaces.

use std::fs;
use std::io::ErrorKind;

/// What is known of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Presence {
    /// It is running (or stopped, or asleep).
    Alive,
    /// It has ended.
    Gone,
    /// It cannot be seen from here.
    Unknown,
}

/// The process of that number that started at that tick.
pub(super) fn presence(pid: u32, started: i64) -> Presence {
    match fs::read_to_string(format!("/proc/{pid}/stat")) {
        Ok(stat) => match state_and_start(&stat) {
            // A zombie has ended, and waits for nothing but its parent.
            Some((state, start)) if start == started && !['Z', 'X'].contains(&state) => Presence::Alive,
            Some(_) => Presence::Gone,
            None => Presence::Unknown,
        },
        // The first process is always there, unless those of other users are hidden.
        Err(error) if error.kind() == ErrorKind::NotFound && fs::exists("/proc/1/stat").unwrap_or(false) => {
            Presence::Gone
        }
        Err(_) => Presence::Unknown,
    }
}

/// When the process of that number started, in ticks since the boot, if the system tells.
pub(super) fn start_of(pid: u32) -> Option<i64> {
    state_and_start(&fs::read_to_string(format!("/proc/{pid}/stat")).ok()?).map(|(_, start)| start)
}

/// What tells this boot of the machine from all others.
pub(super) fn boot_id() -> Option<String> {
    Some(fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?.trim().to_owned())
}

/// The name of the namespace in which this process' number is valid.
pub(super) fn pid_namespace() -> Option<String> {
    Some(fs::read_link("/proc/self/ns/pid").ok()?.to_string_lossy().into_owned())
}

/// The machine's name.
pub(super) fn host() -> String {
    let named =
        fs::read_to_string("/proc/sys/kernel/hostname").ok().or_else(|| std::env::var("HOSTNAME").ok());
    named.map_or_else(|| "unknown".to_owned(), |name| name.trim().to_owned())
}

/// Fields 3 and 22. The second, the command, may hold spaces and parentheses.
fn state_and_start(stat: &str) -> Option<(char, i64)> {
    let mut fields = stat.rsplit_once(')')?.1.split_ascii_whitespace();
    let state = fields.next()?.chars().next()?;
    Some((state, fields.nth(18)?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a command's name with spaces and parentheses does not shift the fields.
    #[test]
    fn odd_names_are_read() {
        let stat = "4242 (a) R (b c) S 1 4242 4242 0 -1 4194304 100 0 0 0 1 2 0 0 20 0 1 0 777 1000 10 0";
        assert_eq!(state_and_start(stat), Some(('S', 777)));
        assert_eq!(state_and_start("4242 (short) S 1 2"), None);
    }

    /// Protects: this process is alive, its number with another start is another process, and a child that ended
    /// is gone, both before and after its parent asked for it.
    #[cfg(target_os = "linux")]
    #[test]
    fn the_end_is_seen() {
        let own = std::process::id();
        let start = start_of(own).unwrap();
        assert_eq!(presence(own, start), Presence::Alive);
        assert_eq!(presence(own, start + 1), Presence::Gone);
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let started = start_of(child.id()).unwrap();
        assert_eq!(presence(child.id(), started), Presence::Alive);
        child.kill().unwrap();
        while presence(child.id(), started) != Presence::Gone {
            std::thread::yield_now();
        }
        child.wait().unwrap();
        assert_eq!(presence(child.id(), started), Presence::Gone);
    }
}
