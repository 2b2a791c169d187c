//! Whether a process is still alive. The process number is not enough: the system uses numbers again after a process
//! has ended, after a boot, and in other namespaces.

use std::fs;
use std::io::ErrorKind;

/// Whether a process is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Presence {
    /// It is running, stopped or asleep.
    Alive,
    /// It has ended.
    Gone,
    /// It is not visible from here.
    Unknown,
}

/// Whether the process `pid` that started at the tick `started` is there.
pub(super) fn presence(pid: u32, started: i64) -> Presence {
    match fs::read_to_string(format!("/proc/{pid}/stat")) {
        Ok(stat) => match state_and_start(&stat) {
            // A zombie (Z) has ended; only its parent has not noticed yet.
            Some((state, start)) if start == started && !['Z', 'X'].contains(&state) => Presence::Alive,
            Some(_) => Presence::Gone,
            None => Presence::Unknown,
        },
        // Process 1 always exists. If it is not visible, the processes of other users are hidden.
        Err(error) if error.kind() == ErrorKind::NotFound && fs::exists("/proc/1/stat").unwrap_or(false) => {
            Presence::Gone
        }
        Err(_) => Presence::Unknown,
    }
}

/// Whether the process `pid` is stopped (by Ctrl-Z, SIGSTOP or a debugger), as far as the system tells.
pub(super) fn is_stopped(pid: u32) -> bool {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat"));
    stat.is_ok_and(|stat| state_and_start(&stat).is_some_and(|(state, _)| ['T', 't'].contains(&state)))
}

/// When the process `pid` started, in clock ticks since the boot, if the system provides it.
pub(super) fn start_tick(pid: u32) -> Option<i64> {
    state_and_start(&fs::read_to_string(format!("/proc/{pid}/stat")).ok()?).map(|(_, start)| start)
}

/// Identifies this boot of the machine.
pub(super) fn boot_id() -> Option<String> {
    Some(fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?.trim().to_owned())
}

/// The name of the namespace in which this process's number is valid.
pub(super) fn pid_namespace() -> Option<String> {
    Some(fs::read_link("/proc/self/ns/pid").ok()?.to_string_lossy().into_owned())
}

/// The machine's name.
pub(super) fn host() -> String {
    gethostname::gethostname().to_string_lossy().into_owned()
}

/// Fields 3 and 22 of `/proc/PID/stat`. Field 2, the command, may contain spaces and parentheses.
fn state_and_start(stat: &str) -> Option<(char, i64)> {
    let mut fields = stat.rsplit_once(')')?.1.split_ascii_whitespace();
    let state = fields.next()?.chars().next()?;
    Some((state, fields.nth(18)?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a command name with spaces and parentheses does not shift the fields.
    #[test]
    fn odd_command_names_are_parsed() {
        let stat = "4242 (a) R (b c) S 1 4242 4242 0 -1 4194304 100 0 0 0 1 2 0 0 20 0 1 0 777 1000 10 0";
        assert_eq!(state_and_start(stat), Some(('S', 777)));
        assert_eq!(state_and_start("4242 (short) S 1 2"), None);
    }

    /// Protects: a stopped process is seen as such until it continues, and it is alive.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_stopped_process_is_seen() {
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let started = start_tick(child.id()).unwrap();
        let send = |signal: &str| {
            let sent = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
            assert!(sent.unwrap().success());
        };
        for (signal, is_expected) in [("-STOP", true), ("-CONT", false)] {
            send(signal);
            let begun = std::time::Instant::now();
            while is_stopped(child.id()) != is_expected {
                assert!(begun.elapsed().as_secs() < 30, "{signal} is not seen");
                std::thread::yield_now();
            }
            assert_eq!(presence(child.id(), started), Presence::Alive);
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!is_stopped(child.id()));
    }

    /// Protects: this process is alive; the same number with another start is another process; and a child that has
    /// ended is gone, both before and after its parent waits for it.
    #[cfg(target_os = "linux")]
    #[test]
    fn the_end_of_a_process_is_seen() {
        let own = std::process::id();
        let start = start_tick(own).unwrap();
        assert_eq!(presence(own, start), Presence::Alive);
        assert_eq!(presence(own, start + 1), Presence::Gone);
        let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let started = start_tick(child.id()).unwrap();
        assert_eq!(presence(child.id(), started), Presence::Alive);
        child.kill().unwrap();
        while presence(child.id(), started) != Presence::Gone {
            std::thread::yield_now();
        }
        child.wait().unwrap();
        assert_eq!(presence(child.id(), started), Presence::Gone);
    }
}
