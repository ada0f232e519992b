//! `pfaff man`, `pfaff completions` and the help contain every command.

use super::{pfaff, stderr, stdout};

/// Returns all commands, as the help lists them.
fn commands() -> Vec<String> {
    let help = stdout(&pfaff(&["--help"]));
    let list = help.split("Commands:").nth(1).expect("commands");
    let list = list.split("\n\n").next().expect("a list");
    let names = list
        .lines()
        .filter_map(|line| line.split_whitespace().next());
    names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_command_has_examples_in_its_help() {
    let commands = commands();
    assert!(commands.len() >= 12, "{commands:?}");
    for command in commands {
        let output = pfaff(&[&command, "--help"]);
        assert_eq!(output.status.code(), Some(0));
        let help = stdout(&output);
        assert!(help.contains("Examples:\n"), "{command}: {help}");
        assert!(
            help.contains(&format!("  pfaff {command}")),
            "{command}: {help}"
        );
        assert!(!help.contains('\u{1b}'), "colours are for terminals");
    }
}

#[test]
fn pages_are_for_man() {
    let whole = stdout(&pfaff(&["man"]));
    assert!(
        whole.starts_with(".ie") && whole.contains(".TH pfaff 1"),
        "{whole}"
    );
    for command in commands() {
        assert!(
            whole.contains(&format!("pfaff\\-{}", command.replace('-', "\\-"))),
            "{command}"
        );
        let page = pfaff(&["man", &command]);
        assert_eq!(page.status.code(), Some(0), "{}", stderr(&page));
        let page = stdout(&page);
        assert!(page.contains(&format!(".TH pfaff-{command} 1")), "{page}");
        // Lines are not joined, and points at their beginning are not commands.
        assert!(page.contains("\n.nf\n"), "{page}");
        assert!(
            page.contains(&format!("\n  pfaff {}", command.replace('-', "\\-"))),
            "{page}"
        );
    }
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = pfaff(&["completions", shell]);
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(0), ""));
        let text = stdout(&output);
        for command in commands() {
            assert!(text.contains(&command), "{shell}: {command}");
        }
    }
}

#[test]
fn unknown_names_are_refused() {
    let page = pfaff(&["man", "analyse"]);
    assert_eq!((page.status.code(), &*stdout(&page)), (Some(2), ""));
    assert!(
        stderr(&page)
            .starts_with("error[P0001]: there is no command `analyse`; there are analyze, "),
        "{}",
        stderr(&page)
    );
    let shell = pfaff(&["completions", "bush"]);
    assert_eq!(shell.status.code(), Some(2));
    assert!(
        stderr(&shell).contains("similar value exists: 'bash'"),
        "{}",
        stderr(&shell)
    );
}
