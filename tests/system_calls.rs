//! What the program asks the operating system for: it writes under `--out` alone, and opens no socket. Watched by
//! strace; skipped where that is missing or may not watch.

use std::path::Path;
use std::process::Command;

use crate::support::folder::Folder;
use crate::support::said::Said;
use crate::support::small::small;
use crate::support::tools::skipped;

/// Less still, for strace is slow.
const TINY: &str = "
skin.around = 4
physics.duration = 500.0
schema = { chains = 2, sweeps = 10 }
experiment = { dimensions = [2, 3], coordinations = [0.4, 0.9], dimension = 3 }
";

/// The system calls of `bodyschema ARGUMENTS`, a line each; none without strace.
fn watch(folder: &Folder, arguments: &str) -> Option<Vec<String>> {
    let strace = |program: &Command| {
        let mut command = Command::new("strace");
        let options = "-f -y -s 4096 -e trace=%file,%network,fchmod,fchown,ftruncate -o calls";
        command.current_dir(folder.path()).args(options.split(' '));
        command.arg(program.get_program()).args(program.get_args()).output()
    };
    if !strace(&Command::new("true")).is_ok_and(|output| output.status.success()) {
        skipped("strace is missing or may not watch");
        return None;
    }
    let said = Said::from(strace(&folder.command(arguments)).unwrap());
    assert!(said.status.unwrap() <= 1, "{said:?}");
    // Without the number of the process that each line begins with.
    let lines = String::from_utf8_lossy(&folder.bytes("calls")).into_owned();
    Some(lines.lines().filter_map(|line| Some(line.split_once(' ')?.1.trim_start().to_owned())).collect())
}

/// The calls that change a file beside those in `out`, or that speak to a network.
fn trespasses(calls: &[String], out: &Path) -> Vec<String> {
    let reads = [
        "access",
        "readlink",
        "stat",
        "getcwd",
        "execve",
        "statx",
        "newfstatat",
        "faccessat",
        "statfs",
        "lstat",
    ];
    let trespass = |call: &&String| {
        // "<... call resumed>" is the end of one whose arguments are on a line before, beside another thread's.
        let Some((name, arguments)) = call.split_once('(').filter(|_| !call.starts_with('<')) else {
            return false;
        };
        let opens = name.starts_with("open");
        let changes =
            ["O_WRONLY", "O_RDWR", "O_CREAT", "O_TRUNC"].iter().any(|flag| arguments.contains(flag));
        if opens && !changes || reads.iter().any(|read| name.starts_with(read)) {
            return false;
        }
        // All paths of the call, in quotes, from the folder in angle brackets if there is one; a call without a path,
        // as of a socket, is never in `out`.
        let base =
            arguments.split_once('<').and_then(|(_, rest)| Some(rest.split_once('>')?.0)).unwrap_or("");
        let mut paths = arguments.split('"').skip(1).step_by(2).peekable();
        let named = paths.peek().is_some();
        !(named && paths.all(|path| Path::new(base).join(path).starts_with(out)))
    };
    calls.iter().filter(trespass).cloned().collect()
}

#[test]
fn an_experiment_writes_under_out_alone_and_opens_no_socket() {
    let folder = Folder::new();
    folder.write("small.toml", small(TINY));
    for experiment in ["exp1", "exp2"] {
        let out = folder.at(experiment);
        let arguments = format!("reproduce {experiment} --settings small.toml --out {}", out.display());
        let Some(calls) = watch(&folder, &arguments) else { return };
        assert!(calls.len() > 100, "{calls:?}");
        assert_eq!(trespasses(&calls, &out), [""; 0]);
        // The twin: the same calls, had another folder been given.
        let elsewhere = trespasses(&calls, &folder.at("elsewhere"));
        assert!(elsewhere.iter().any(|call| call.contains("report.html")), "{elsewhere:?}");
        assert!(!trespasses(&["socket(AF_INET, SOCK_STREAM, 0) = 3".to_owned()], &out).is_empty());
    }
}
