//! Connections that are lost in the middle of an exchange. A relay between the queue and the server cuts them where the
//! test demands.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;

use tribosweep::queue::{Claim, Clock, Finished, Location, Queue, QueueError, Scope, TakenBack, Worker};

use crate::orchestration::support::{Engine, Sandbox, counts, done, foreign_worker, keys, study};

/// When the relay cuts the connection, once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cut {
    Never,
    /// Before it forwards a COMMIT.
    BeforeCommit,
    /// After it has forwarded a COMMIT, before it forwards the answer.
    AfterCommit,
    /// At the next message of the client.
    Now,
}

/// Starts a relay to the server. Returns its port.
fn relay(server: String, cut: Arc<Mutex<Cut>>) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    thread::spawn(move || {
        for client in listener.incoming() {
            let (client, server) = (client.unwrap(), TcpStream::connect(&server).unwrap());
            let cut = Arc::clone(&cut);
            thread::spawn(move || forward(client, server, &cut));
        }
    });
    port
}

fn forward(mut client: TcpStream, mut server: TcpStream, cut: &Mutex<Cut>) {
    let (mut answers, mut back) = (server.try_clone().unwrap(), client.try_clone().unwrap());
    let is_lost = Arc::new(Mutex::new(false));
    let is_lost_there = Arc::clone(&is_lost);
    thread::spawn(move || {
        let mut bytes = vec![0; 65_536];
        while let Ok(count @ 1..) = answers.read(&mut bytes) {
            if *is_lost_there.lock().unwrap() || back.write_all(&bytes[..count]).is_err() {
                break;
            }
        }
        let _ = back.shutdown(Shutdown::Both);
    });
    let mut bytes = vec![0; 65_536];
    while let Ok(count @ 1..) = client.read(&mut bytes) {
        let is_commit = bytes[..count].windows(6).any(|window| window == b"COMMIT");
        let mut cut = cut.lock().unwrap();
        match *cut {
            Cut::Now => {
                *cut = Cut::Never;
                break;
            }
            Cut::BeforeCommit if is_commit => {
                *cut = Cut::Never;
                break;
            }
            Cut::AfterCommit if is_commit => {
                *cut = Cut::Never;
                *is_lost.lock().unwrap() = true;
            }
            _ => {}
        }
        server.write_all(&bytes[..count]).unwrap();
    }
    let _ = client.shutdown(Shutdown::Both);
    let _ = server.shutdown(Shutdown::Both);
}

struct Relayed {
    sandbox: Sandbox,
    cut: Arc<Mutex<Cut>>,
    location: Location,
}

impl Relayed {
    fn new() -> Option<Self> {
        let sandbox = Sandbox::of(Engine::Postgres)?;
        let Location::Server(server) = sandbox.location() else { unreachable!() };
        let (scheme, rest) = server.url().split_once("://").unwrap();
        let (authority, database) = rest.rsplit_once('/').unwrap();
        let (user, address) = authority.rsplit_once('@').unwrap();
        let cut = Arc::new(Mutex::new(Cut::Never));
        let port = relay(address.to_owned(), Arc::clone(&cut));
        let url = format!("{scheme}://{user}@127.0.0.1:{port}/{database}");
        Some(Self { sandbox, cut, location: Location::parse(url.into()) })
    }

    async fn open(&self) -> Queue {
        let mut queue = Queue::open(self.location.clone(), self.sandbox.clock.clock()).await.unwrap();
        queue.register(&Worker::this_process(1, "test", "provenance")).await.unwrap();
        queue
    }

    fn cut(&self, when: Cut) {
        *self.cut.lock().unwrap() = when;
    }
}

fn finished(key: &str) -> Finished {
    Finished { key: key.into(), attempt: 1, outcome: done(&format!("record of {key}")), wall_s: 0.1 }
}

const TWO: [Claim; 1] = [Claim { scope: Scope::All, limit: 2, batch: None }];

/// Protects: after an exchange whose answer was lost, a repeated exchange stores each outcome once and refuses none,
/// whether the lost transaction was committed or not. The worker then holds exactly the jobs that it knows of. Jobs
/// that it claimed in the lost transaction are claimed again, by it and by nobody else.
#[tokio::test]
async fn an_exchange_in_doubt_is_done_once() {
    for when in [Cut::BeforeCommit, Cut::AfterCommit, Cut::Now] {
        let Some(relayed) = Relayed::new() else { return };
        let mut queue = relayed.open().await;
        queue.submit(&study("a", &["p", "q", "r", "s", "t", "u"])).await.unwrap();
        let first = queue.exchange(&[], &TWO).await.unwrap().claimed.remove(0);
        assert_eq!(keys(&first), ["p", "q"]);

        relayed.cut(when);
        let error = queue.exchange(&[finished("p")], &TWO).await.unwrap_err();
        assert!(matches!(error, QueueError::Unreachable(_)), "{when:?}: {error:?}");
        let mut witness = relayed.sandbox.open_as(&foreign_worker()).await;
        let kept = if when == Cut::AfterCommit { counts(2, 3, 1, 0) } else { counts(4, 2, 0, 0) };
        assert_eq!(witness.counts(&Scope::All).await.unwrap(), kept, "{when:?}");

        let again = queue.exchange(&[finished("p")], &TWO).await.unwrap();
        assert!(again.refused.is_empty(), "{when:?}: {:?}", again.refused);
        assert_eq!(keys(&again.claimed[0]), ["r", "s"]);
        assert!(again.claimed[0].iter().all(|job| job.attempt == 1), "{when:?}: {:?}", again.claimed);
        assert_eq!(witness.counts(&Scope::All).await.unwrap(), counts(2, 3, 1, 0), "{when:?}");

        let rest = queue.exchange(&["q", "r", "s"].map(finished), &TWO).await.unwrap();
        assert!(rest.refused.is_empty());
        assert_eq!(keys(&rest.claimed[0]), ["t", "u"]);
        assert!(queue.exchange(&["t", "u"].map(finished), &[]).await.unwrap().refused.is_empty());
        assert_eq!(relayed.sandbox.number("SELECT COUNT(*) FROM results").await, 6);
        assert_eq!(relayed.sandbox.number("SELECT CAST(SUM(attempt) AS BIGINT) FROM jobs").await, 6);
    }
}

/// Protects: a worker that was disconnected for longer than its lease continues afterwards and counts as active.
/// Outcomes of jobs that another worker has claimed meanwhile are refused.
#[tokio::test]
async fn a_worker_continues_after_a_long_disconnection() {
    let Some(relayed) = Relayed::new() else { return };
    let location = relayed.location.clone();
    let mut away = Queue::open(location, relayed.sandbox.clock.clock()).await.unwrap();
    away.register(&foreign_worker()).await.unwrap();
    away.submit(&study("a", &["p", "q", "r"])).await.unwrap();
    away.exchange(&[], &TWO).await.unwrap();
    let mut other = relayed.sandbox.open().await;
    relayed.sandbox.clock.set(120_000);
    assert_eq!(other.take_back().await.unwrap(), TakenBack { pending: 2, failed: 0 });
    let lost = other.workers().await.unwrap();
    assert!(lost.iter().any(|worker| worker.host == "elsewhere" && worker.taken_back == 2), "{lost:?}");
    assert_eq!(keys(&other.exchange(&[], &TWO).await.unwrap().claimed[0]), ["p", "q"]);

    relayed.cut(Cut::Now);
    assert!(away.heartbeat().await.is_err());
    assert_eq!(away.heartbeat().await.unwrap(), 0);
    let late = away.exchange(&[finished("p"), finished("q")], &TWO).await.unwrap();
    assert_eq!(late.refused, ["p", "q"]);
    assert_eq!(keys(&late.claimed[0]), ["r"]);
    assert_eq!(other.take_back().await.unwrap(), TakenBack::default(), "the worker is active again");
    assert_eq!(other.active_workers().await.unwrap().workers, 2);
}

/// Protects: a server that does not answer is an immediate error, which names the server and does not show the
/// password.
#[cfg(feature = "postgres")]
#[tokio::test]
async fn a_missing_server_is_named() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let location = Location::parse(format!("postgres://ada:secret@127.0.0.1:{port}/x").into());
    let error = Queue::open(location, Clock::OfDatabase).await.unwrap_err().to_string();
    assert!(error.contains(&format!("postgres://ada@127.0.0.1:{port}/x")), "{error}");
    assert!(error.contains("no answer") && !error.contains("secret"), "{error}");
}
