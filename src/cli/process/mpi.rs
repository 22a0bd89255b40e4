//! Processes of a team that are connected by MPI.

use std::time::Duration;

use mpi::environment::{Universe, initialize_with_threading};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, Source};
use mpi::{Threading, request};

use crate::outofcore::Team;

/// The number of bytes sent at once, as the counts of MPI have 32 bits.
const CHUNK: usize = 1 << 20;
/// MPI waits by polling, which occupies a core that working threads need. So it is polled this many times without a pause, and
/// then once every [`PAUSE`].
const EAGER: u32 = 200;
const PAUSE: Duration = Duration::from_micros(500);

/// All processes that mpirun started. MPI ends when this is dropped.
pub(crate) struct World {
    world: SimpleCommunicator,
    _universe: Universe,
}

impl World {
    /// Starts MPI; `None` if it has been started before. Only this thread may use it.
    pub(crate) fn start() -> Option<Self> {
        let (universe, _) = initialize_with_threading(Threading::Funneled)?;
        Some(Self { world: universe.world(), _universe: universe })
    }

    /// Ends all processes at once.
    pub(crate) fn abort(&self, code: u8) -> ! {
        self.world.abort(code.into())
    }

    fn send_chunk(&self, to: usize, chunk: &[u8]) {
        let process = self.world.process_at_rank(to as i32);
        request::scope(|scope| {
            let mut pending = Some(process.immediate_send(scope, chunk));
            wait(|| {
                pending
                    .take()
                    .and_then(|sending| sending.test().map_err(|s| pending = Some(s)).ok())
            });
        });
    }

    fn receive_chunk(&self, from: usize, chunk: &mut [u8]) {
        let process = self.world.process_at_rank(from as i32);
        let (message, _) = wait(|| process.immediate_matched_probe());
        message.matched_receive_into(chunk);
    }
}

impl Team for World {
    fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    fn size(&self) -> usize {
        self.world.size() as usize
    }

    fn send(&self, to: usize, message: &[u8]) {
        self.send_chunk(to, &(message.len() as u64).to_le_bytes());
        message.chunks(CHUNK).for_each(|chunk| self.send_chunk(to, chunk));
    }

    fn receive(&self, from: usize) -> Vec<u8> {
        let mut length = [0; 8];
        self.receive_chunk(from, &mut length);
        let mut message = vec![0; u64::from_le_bytes(length) as usize];
        message.chunks_mut(CHUNK).for_each(|chunk| self.receive_chunk(from, chunk));
        message
    }
}

/// Polls until there is a result.
fn wait<T>(mut poll: impl FnMut() -> Option<T>) -> T {
    for polled in 0u32.. {
        if let Some(answer) = poll() {
            return answer;
        }
        if polled >= EAGER {
            std::thread::sleep(PAUSE);
        }
    }
    unreachable!("it polls for ever")
}
