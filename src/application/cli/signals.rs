//! Ctrl-C and SIGTERM.

use super::output::log;
use crate::exit;
use crate::worker::Interrupt;
use std::time::{Duration, Instant};

/// One request to stop may arrive as several signals, to the process and to its group.
const ONE_REQUEST: Duration = Duration::from_secs(1);

/// Raises the interrupt at the first signal and logs `message`. A second signal, at least [`ONE_REQUEST`] later, ends the
/// process immediately.
pub(crate) async fn raise_on_signal(interrupt: Interrupt, message: &str) {
    stop_signal().await;
    log(format_args!("{message} (press Ctrl-C again to stop immediately)"));
    interrupt.raise();
    let requested = Instant::now();
    while requested.elapsed() < ONE_REQUEST {
        stop_signal().await;
    }
    std::process::exit(i32::from(exit::WORK_LEFT));
}

/// Waits for Ctrl-C or, on Unix, SIGTERM.
#[cfg(unix)]
async fn stop_signal() {
    use tokio::signal::unix::{SignalKind, signal};
    match signal(SignalKind::terminate()) {
        Ok(mut terminate) => {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = terminate.recv() => {}
            }
        }
        Err(_) => drop(tokio::signal::ctrl_c().await),
    }
}

/// Waits for Ctrl-C.
#[cfg(not(unix))]
async fn stop_signal() {
    drop(tokio::signal::ctrl_c().await);
}
