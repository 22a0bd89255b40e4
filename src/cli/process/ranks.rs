//! Processes that a launcher such as mpirun started for one command.

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};

use walpha_base::advice::Category;

use crate::cli::options::global::{PANICKED, SUCCESS, USAGE};
use crate::cli::process::errors::{self, CommandError, ErrorForm, Result, command_error};
use crate::outofcore::{Alone, Team};

/// The role of this process among those started for the command.
pub(crate) enum Ranks {
    /// The only process.
    Single,
    /// One of several processes that were started for one command but cannot communicate. All except the first have nothing to
    /// do.
    Unconnected(Launched),
    /// One of several that share the work.
    #[cfg(feature = "mpi")]
    Connected(crate::cli::process::mpi::World),
}

/// The rank and size that a launcher set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Launched {
    rank: usize,
    size: usize,
    /// The environment variable that contains the size.
    variable: &'static str,
}

/// The environment variables in which launchers set the number of processes, and the rank of this one.
const VARIABLES: [[&str; 2]; 4] = [
    // Open MPI.
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    // MPICH, Intel MPI, and Slurm when it starts these.
    ["PMI_SIZE", "PMI_RANK"],
    ["MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"],
    // srun. The variables that sbatch sets in its script have other names.
    ["SLURM_STEP_NUM_TASKS", "SLURM_PROCID"],
];

impl Launched {
    /// Reads rank and size from the environment, if there is more than one process.
    fn of(variable: impl Fn(&str) -> Option<OsString>) -> Option<Self> {
        let number = |name: &str| variable(name)?.to_str()?.trim().parse::<usize>().ok();
        let launched = VARIABLES.iter().filter_map(|[size, rank]| {
            Some(Self { rank: number(rank)?, size: number(size)?, variable: size })
        });
        launched.into_iter().find(|launched| launched.size > 1)
    }

    /// The error for a command that several processes cannot share.
    fn refusal(self, command: &str) -> CommandError {
        let Self { size, variable, .. } = self;
        let each = format!("unset {variable} where each process is to work on its own");
        let said = if command != SHARED {
            command_error!("{size} processes were started, and would all do the same: of the commands only {SHARED} can be shared" => "start one process, or {each}")
        } else if cfg!(feature = "mpi") {
            command_error!("{size} processes were started, but not by the MPI that this walpha was built with" => "start it with the mpirun of that MPI, or build it again; {each}")
        } else {
            command_error!("{size} processes were started, and this walpha was built without MPI, so that all would write the same files" => "build it with `cargo install --features mpi`, or start one process; {each}")
        };
        CommandError { category: Category::Usage, ..said }
    }
}

/// The command that several processes share.
const SHARED: &str = "walpha shape";
/// What the commands begin with whose processes are independent.
const SINGLE: &str = "walpha blocks ";

impl Ranks {
    /// Determines how this process was started to run a command, and connects to the others.
    pub(crate) fn find(command: &str) -> Self {
        match Launched::of(|name| std::env::var_os(name)) {
            Some(launched) if !command.starts_with(SINGLE) => Self::of(launched, command),
            _ => Self::Single,
        }
    }

    #[cfg(feature = "mpi")]
    fn of(launched: Launched, command: &str) -> Self {
        let world = if command == SHARED { crate::cli::process::mpi::World::start() } else { None };
        match world {
            Some(world) if world.size() == launched.size => Self::Connected(world),
            _ => Self::Unconnected(launched),
        }
    }

    #[cfg(not(feature = "mpi"))]
    fn of(launched: Launched, _: &str) -> Self {
        Self::Unconnected(launched)
    }

    /// The processes that share the work.
    pub(crate) fn team(&self) -> &dyn Team {
        match self {
            Self::Single | Self::Unconnected(_) => &Alone,
            #[cfg(feature = "mpi")]
            Self::Connected(world) => world,
        }
    }

    /// Runs the command line in the first process, while the others serve it. A failure or panic ends all of them; the error of
    /// `lead` is the exit code of a failure.
    pub(crate) fn run(
        &self,
        command: &str,
        lead: impl FnOnce() -> Result<u8, u8>,
        serve: impl FnOnce() -> Result<()>,
    ) -> u8 {
        let is_first = self.team().rank() == 0;
        if let Self::Unconnected(launched) = self {
            if launched.rank > 0 {
                return SUCCESS;
            }
            errors::print_error(command, &launched.refusal(command), ErrorForm::Text);
            return USAGE;
        }
        let done = if is_first {
            catch_unwind(AssertUnwindSafe(lead))
        } else {
            catch_unwind(AssertUnwindSafe(|| {
                serve().map(|()| SUCCESS).map_err(|error| self.report_failure(command, &error))
            }))
        };
        match done {
            Ok(Ok(code)) => code,
            Ok(Err(code)) => self.end(code),
            // The message of the panic is on standard error already.
            Err(_) => self.end(PANICKED),
        }
    }

    /// Reports a failure in a process other than the first, and returns its exit code.
    fn report_failure(&self, command: &str, error: &CommandError) -> u8 {
        /// If all processes fail, the first reports it and ends the others within this time.
        const PATIENCE: std::time::Duration = std::time::Duration::from_secs(2);
        std::thread::sleep(PATIENCE);
        errors::print_error(
            &format!("{command} (rank {})", self.team().rank()),
            error,
            ErrorForm::Text,
        );
        errors::exit_code(error)
    }

    /// Ends all processes.
    fn end(&self, code: u8) -> u8 {
        match self {
            #[cfg(feature = "mpi")]
            Self::Connected(world) => world.abort(code),
            _ => code,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn launched(variables: &[(&str, &str)]) -> Option<(usize, usize)> {
        let value = |name: &str| variables.iter().find(|(known, _)| *known == name);
        let launched = Launched::of(|name| value(name).map(|(_, value)| value.into()));
        launched.map(|launched| (launched.rank, launched.size))
    }

    #[test]
    fn launchers_are_recognised() {
        assert_eq!(launched(&[]), None);
        let one = [("OMPI_COMM_WORLD_SIZE", "1"), ("OMPI_COMM_WORLD_RANK", "0")];
        assert_eq!(launched(&one), None);
        assert_eq!(launched(&[("PMI_SIZE", "8"), ("PMI_RANK", "3")]), Some((3, 8)));
        // This is srun, which need not use a dialect of MPI; followed by a script of sbatch, which is one process.
        let step = [("SLURM_NTASKS", "4"), ("SLURM_STEP_NUM_TASKS", "4"), ("SLURM_PROCID", "2")];
        assert_eq!(launched(&step), Some((2, 4)));
        assert_eq!(launched(&[("SLURM_NTASKS", "4"), ("SLURM_PROCID", "0")]), None);
    }
}
