//! Processes that compute one shape together.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// One of several processes that compute a shape together, such as the ranks of MPI. All have access to the folder of the plan,
/// and call the same functions with the same arguments in the same order.
///
/// Messages between two processes arrive in the order in which they were sent. A process that fails must end the others, which
/// would otherwise wait for it.
///
/// ```
/// use walpha_model::outofcore::{Alone, Team};
///
/// assert_eq!((Alone.rank(), Alone.size()), (0, 1));
/// ```
pub trait Team {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;
    /// The number of processes, at least one.
    fn size(&self) -> usize;
    /// Sends a message of any length to another process. This may wait until the message is received.
    fn send(&self, to: usize, message: &[u8]);
    /// Waits for the next message from another process.
    fn receive(&self, from: usize) -> Vec<u8>;
}

/// A single process without others.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Team for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn send(&self, _: usize, _: &[u8]) {
        unreachable!("there is nobody else")
    }

    fn receive(&self, _: usize) -> Vec<u8> {
        unreachable!("there is nobody else")
    }
}

impl dyn Team + '_ {
    /// Whether this is the first process, which acts for all.
    #[doc(hidden)]
    pub fn is_first(&self) -> bool {
        self.rank() == 0
    }

    /// The numbers of the parts of this process, of `parts` equal ones: every `size`-th.
    pub(crate) fn own(&self, parts: usize) -> impl Iterator<Item = usize> {
        (self.rank()..parts).step_by(self.size())
    }

    /// Joins the values of all processes, in any order, and gives the result to all. Each process sends ⌈log₂ size⌉ messages to
    /// the first and back.
    #[doc(hidden)]
    pub fn reduce<T: Serialize + DeserializeOwned>(
        &self,
        mut mine: T,
        mut join: impl FnMut(&mut T, T),
    ) -> T {
        let (rank, size) = (self.rank(), self.size());
        let mut step = 1;
        while step < size {
            if rank & step != 0 {
                self.send(rank - step, &packed(&mine));
                break;
            }
            if rank + step < size {
                join(&mut mine, unpacked(&self.receive(rank + step)));
            }
            step *= 2;
        }
        self.broadcast(self.is_first().then_some(mine))
    }

    /// Gives the value of the first process to all; the others pass `None`.
    #[doc(hidden)]
    pub fn broadcast<T: Serialize + DeserializeOwned>(&self, first: Option<T>) -> T {
        let (rank, size) = (self.rank(), self.size());
        let (mut known, mut message) = (first, Vec::new());
        if let Some(known) = known.as_ref().filter(|_| size > 1) {
            message = packed(known);
        }
        for step in (0..size.next_power_of_two().ilog2()).rev().map(|power| 1 << power) {
            if rank.is_multiple_of(2 * step) && rank + step < size {
                self.send(rank + step, &message);
            } else if rank % (2 * step) == step {
                message = self.receive(rank - step);
                known = Some(unpacked(&message));
            }
        }
        known.expect("the first process has it")
    }

    /// Waits until all processes have reached this call.
    #[doc(hidden)]
    pub fn barrier(&self) {
        self.reduce((), |(), ()| ());
    }

    /// Moves files to their final names, after all processes have written theirs: the others first, and then the first process,
    /// whose files refer to those of the others.
    #[doc(hidden)]
    pub fn first_last<T, E>(&self, put: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        self.barrier();
        if self.is_first() {
            self.barrier();
            put()
        } else {
            let done = put()?;
            self.barrier();
            Ok(done)
        }
    }
}

fn packed<T: Serialize>(what: &T) -> Vec<u8> {
    postcard::to_allocvec(what).expect("numbers, texts and lists of these")
}

/// Unpacks a message. All processes run the same program, so that each can unpack the messages of the others.
fn unpacked<T: DeserializeOwned>(message: &[u8]) -> T {
    postcard::from_bytes(message).expect("packed by the same program")
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::mpsc::{Receiver, Sender, channel};

    use super::*;
    use crate::Recipe;
    use crate::outofcore::{BlockwiseFormat, Cutting, Job, Plan, merge, run_all, run_missing};

    use walpha_points::Weighting;
    use walpha_volume::GrayRange;

    /// A thread that takes the role of a process.
    struct Thread {
        rank: usize,
        to: Vec<Sender<Vec<u8>>>,
        from: Vec<Receiver<Vec<u8>>>,
    }

    impl Team for Thread {
        fn rank(&self) -> usize {
            self.rank
        }

        fn size(&self) -> usize {
            self.to.len()
        }

        fn send(&self, to: usize, message: &[u8]) {
            self.to[to].send(message.into()).unwrap();
        }

        fn receive(&self, from: usize) -> Vec<u8> {
            self.from[from].recv().unwrap()
        }
    }

    fn team(size: usize) -> Vec<Thread> {
        let empty = |rank| Thread { rank, to: Vec::new(), from: Vec::new() };
        let mut team: Vec<Thread> = (0..size).map(empty).collect();
        for from in 0..size {
            for to in 0..size {
                let (sender, receiver) = channel();
                team[from].to.push(sender);
                team[to].from.push(receiver);
            }
        }
        team
    }

    #[test]
    fn reduce_and_broadcast_reach_all_ranks() {
        for size in [1, 2, 3, 5, 8, 13] {
            std::thread::scope(|scope| {
                for member in team(size) {
                    scope.spawn(move || {
                        let team: &dyn Team = &member;
                        let all = team.reduce(vec![team.rank()], Extend::extend);
                        let mut sorted = all.clone();
                        sorted.sort_unstable();
                        assert_eq!(sorted, (0..size).collect::<Vec<_>>());
                        let received = team.broadcast(team.is_first().then_some(all.clone()));
                        assert_eq!(received, all);
                        team.barrier();
                    });
                }
            });
        }
    }

    /// The survey, blocks and outputs do not depend on the number of processes, some of which have no tile or block.
    #[test]
    fn a_team_makes_what_one_makes() {
        let range = GrayRange { low: -3.0, high: 190.0 };
        let recipe = Recipe::new().gray(range).weighting(Weighting::Barycentric);
        let job = Job::new("sample:phantom@90", recipe).unwrap();
        let cutting = Cutting { blocks: Some(3), ..Cutting::default() };
        let folder = tempfile::tempdir().unwrap();
        let expected = Plan::make(job.clone(), cutting, folder.path(), &Alone).unwrap();
        run_all(&expected, &[0, 1, 2]).unwrap();
        let merged = merge(&expected).unwrap();
        let bytes = |at: &Path, file: &str| std::fs::read(at.join(file)).unwrap();
        for size in [2, 3, 5] {
            let other = tempfile::tempdir().unwrap();
            std::thread::scope(|scope| {
                for member in team(size) {
                    let (job, at, expected) = (job.clone(), other.path(), &expected);
                    scope.spawn(move || {
                        let team: &dyn Team = &member;
                        let plan = Plan::resume(job.clone(), cutting, at, team).unwrap();
                        assert_eq!(plan.digest(), expected.digest());
                        assert_eq!(Plan::resume(job, cutting, at, team).unwrap(), plan);
                        run_missing(&plan, team).unwrap();
                        let merged = team.is_first().then(|| merge(&plan).unwrap());
                        let (kind, path) = (BlockwiseFormat::Surface, at.join("out.pvtp"));
                        kind.write(&plan, merged.as_ref(), &path, team).unwrap();
                    });
                }
            });
            BlockwiseFormat::Surface
                .write(&expected, Some(&merged), &folder.path().join("out.pvtp"), &Alone)
                .unwrap();
            let blocks = ["0", "1", "2"]
                .map(|i| [format!("block-0000{i}.walpha"), format!("out/out_{i}.vtp")]);
            let rest = ["plan.json", "sums.f64", "out.pvtp"].map(String::from);
            for file in blocks.as_flattened().iter().chain(&rest) {
                assert!(bytes(other.path(), file) == bytes(folder.path(), file), "{size}: {file}");
            }
        }
    }

    #[test]
    fn parts_have_one_owner() {
        let mut owned = Vec::new();
        for member in team(3) {
            owned.extend((&member as &dyn Team).own(10));
        }
        owned.sort_unstable();
        assert_eq!(owned, (0..10).collect::<Vec<_>>());
    }
}
