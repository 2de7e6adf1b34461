//! The subcommand simulate.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::Args;
use serde::Serialize;

use super::options::{SettingsAndSeed, metres, paper, seconds, set, with_default};
use super::output::say;
use crate::files::body::{NamedBody, read_body};
use crate::files::import::at_one_place;
use crate::files::moved_body::MovedBody;
use crate::files::{FrontEnd, npy, prepare_folder, tables};
use crate::movement::{Played, Playing, move_as_recorded};
use crate::numerics::rng::stream;
use crate::settings::Settings;
use crate::stages::agent::Agent;
use crate::stages::sense::{Sense, sense};
use crate::stages::simulate::{Trajectory, simulate};
use crate::tasks::progress::progress;

/// Stages 1 and 2: simulates a body that moves at random in a fluid, and records the pressures on its sensors.
///
/// With the setting motion.movement = "rhythmic", the body swims: its joints swing as sinusoids that are out of phase. The setting
/// motion.coordination is p, how probably a joint is locked for an epoch, of both movements; a body that shall travel needs p = 0
/// (--settings reproduce/rhythmic.toml).
///
/// With --movement, the body moves as it was recorded instead, and no physics engine is asked: its sensors feel the speeds that
/// the recording has, at its frames, or every sense.interval if --settings has that (not in the paper).
///
/// Writes into DIR: tactile.npy (float32, T x M, Pa), labels.csv (sensor,part), tree.csv (child,parent; place, where several parts turn about one) and
/// joint-angles.csv (time_s, then the angles of each joint in rad; T + 1 rows); for `view` also solids.csv, sensors.csv and
/// poses.npy (float32, T + 1 x 7 for each solid); with --body or --movement also names.csv (part,name). T is the number
/// of samples in time, M the number of sensors.
#[derive(Args)]
pub(super) struct Simulate {
    #[command(flatten)]
    common: SettingsAndSeed,
    /// Body to simulate, instead of the one in the settings: a .toml file, such as those in the folder bodies
    #[arg(long, value_name = "FILE")]
    body: Option<PathBuf>,
    /// Recorded movement that the body makes, instead of one at random: a BVH file. Without --body, its skeleton is the body, as
    /// `body import` makes it
    #[arg(long, value_name = "FILE")]
    movement: Option<PathBuf>,
    /// Length of a unit of the recorded movement, m [default: as in the body; without --body, guessed]
    #[arg(long, value_name = "METRES", value_parser = metres, requires = "movement")]
    scale: Option<f64>,
    /// Play all frames of the recorded movement, and not the longest stretch without a jump
    #[arg(long, requires = "movement")]
    keep_jumps: bool,
    #[arg(long, value_name = "SECONDS", value_parser = seconds,
          help = with_default("Time that is simulated, s; of a recorded movement at most its length", paper().physics.duration))]
    duration: Option<f64>,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct NameRow {
    part: usize,
    name: String,
}

impl Simulate {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let mut settings = self.common.load(false)?;
        set(&mut settings.physics.duration, self.duration);
        let body = self.body.as_deref().map(read_body).transpose()?;
        if let Some(movement) = &self.movement {
            let playing = Playing {
                scale: self.scale,
                keep_jumps: self.keep_jumps,
                interval: self.common.file.has("sense", "interval")?.then_some(settings.sense.interval),
                duration: settings.physics.duration,
                front_end: FrontEnd::CommandLine,
            };
            let played = move_as_recorded(movement, self.body.as_deref().zip(body), &playing)?;
            let Played { body, trajectory, interval, notes, cut } = played;
            settings.sense.interval = interval;
            prepare_folder(&self.out)?;
            let told = format!("{interval} s apart");
            self.write(&body.agent, Some(body.rigid_names()), &trajectory, &settings.sense, &told)?;
            let turn = trajectory.resolution.turn;
            let turn = format!("a part turns by at most {turn:.3} revolutions between two samples");
            let notes = notes.into_iter().chain(cut).chain([turn]);
            notes.into_iter().try_for_each(|note| say(format!("note: {note}")))?;
            return Ok(ExitCode::SUCCESS);
        }
        let Settings { agent, skin, motion, physics, sense: tactile_sense, experiment, .. } = &settings;
        let names = body.as_ref().map(NamedBody::rigid_names);
        let agent = body.map_or_else(|| Agent::new(agent, skin), |body| body.agent);
        settings.check_times(agent.sites.len())?;
        prepare_folder(&self.out)?;
        let interval = tactile_sense.interval;
        let bar = progress(physics.samples(interval) as u64 + 1, "simulate".to_owned());
        let mut rng = stream(experiment.seed, 1, "motion", 0);
        let trajectory = simulate(&agent, motion, physics, interval, &mut rng, &|| bar.inc(1))?;
        bar.finish_and_clear();
        self.write(&agent, names, &trajectory, tactile_sense, &format!("seed {}", experiment.seed))?;
        say(trajectory.resolution.in_words("this movement"))?;
        Ok(ExitCode::SUCCESS)
    }

    /// Writes all files.
    fn write(
        &self,
        agent: &Agent,
        names: Option<Vec<String>>,
        trajectory: &Trajectory,
        settings: &Sense,
        told: &str,
    ) -> Result<()> {
        let out = &self.out;
        let truth = agent.truth();
        tables::write_truth(&out.join("labels.csv"), &out.join("tree.csv"), &truth)?;
        let shared = at_one_place(&truth, names.as_deref());
        if let Some(names) = names {
            let rows = names.into_iter().enumerate().map(|(part, name)| NameRow { part, name });
            tables::write_rows(&out.join("names.csv"), rows)?;
        }
        tables::write_joint_angles(
            &out.join("joint-angles.csv"),
            &agent.joints,
            trajectory,
            settings.interval,
        )?;
        MovedBody::of(agent, trajectory).write(out, &agent.rigid_bodies())?;
        if let Some(note) = shared {
            say(format!("note: {note}; their joints have the same `place` in tree.csv"))?;
        }
        let tactile = sense(agent, trajectory, settings);
        npy::write_tactile(&out.join("tactile.npy"), &tactile)?;
        let (samples, sensors) = (tactile.samples, tactile.sensors());
        let parts = truth.tree.len() + 1;
        say(format!("{samples} samples of {sensors} sensors on {parts} parts, {told}, in {}", out.display()))
    }
}
