//! `stepwave completions` and `stepwave man`: from the same definitions as `--help`.

use std::path::Path;

use clap::CommandFactory;

use crate::models::installed;

use crate::Error;
use crate::cli::{Cli, Registers, registers};
use crate::output::{self, Outputs};

/// Prints the completion script of a shell.
pub(crate) fn completions(shell: clap_complete::Shell) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "stepwave", &mut script);
    let mut script = String::from_utf8_lossy(&script).into_owned();
    match shell {
        clap_complete::Shell::Bash => script += &bash_registers(),
        clap_complete::Shell::Fish => script += &fish_models(),
        _ => {}
    }
    output::print_data(&script)
}

/// What makes fish offer models, as its script knows options only, until one is on the line.
fn fish_models() -> String {
    let names: Vec<&str> = installed().iter().map(|model| model.name).collect();
    let names = names.join(" ");
    let line = |command: &str| {
        format!(
            "complete -c stepwave -n \"__fish_stepwave_using_subcommand {command}; and not __fish_seen_subcommand_from {names}\" \
             -f -a \"{names}\"\n"
        )
    };
    ["run", "export", "sweep", "widths", "prove"].map(line).concat()
}

/// What makes bash offer the registers of the very model, where one is on the line, and no blank after `f=`.
fn bash_registers() -> String {
    let mut cases = String::new();
    for model in installed().iter() {
        for (option, which) in [("width", Registers::Resizable), ("trace", Registers::All)] {
            cases +=
                &format!("            {option},{}) echo \"{}\" ;;\n", model.name, registers(model, which).join(" "));
        }
    }
    format!(
        r#"
_stepwave_registers() {{
    local word
    for word in "${{COMP_WORDS[@]:0:COMP_CWORD}}"; do
        case "$1,$word" in
{cases}        esac
    done
}}

_stepwave_with_registers() {{
    local registers suffix
    case "$3" in
        --width|--narrower) suffix="="; registers=$(_stepwave_registers width) ;;
        --trace|--trace-exclude) suffix=""; registers=$(_stepwave_registers trace) ;;
        *) _stepwave "$@"; return ;;
    esac
    if [[ -z "$registers" ]]; then
        _stepwave "$@"
    else
        COMPREPLY=( $(compgen -W "$registers" -S "$suffix" -- "$2") )
    fi
    if [[ -n "$suffix" ]]; then
        compopt -o nospace 2>/dev/null
    fi
    return 0
}}

if [[ "${{BASH_VERSINFO[0]}}" -eq 4 && "${{BASH_VERSINFO[1]}}" -ge 4 || "${{BASH_VERSINFO[0]}}" -gt 4 ]]; then
    complete -F _stepwave_with_registers -o nosort -o bashdefault -o default stepwave
else
    complete -F _stepwave_with_registers -o bashdefault -o default stepwave
fi
"#
    )
}

/// Writes a manual page for the program, for each command and for each command of a command.
pub(crate) fn manual(dir: &Path) -> Result<(), Error> {
    let mut outputs = Outputs::default();
    // Pages speak of `stepwave help` in its own place; a page each for `help run`, `help list`, … would say nothing.
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    pages(&mut outputs, dir, &program, "stepwave")?;
    outputs.commit()
}

fn pages(outputs: &mut Outputs, dir: &Path, command: &clap::Command, name: &str) -> Result<(), Error> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone()).title(name.to_uppercase()).render(&mut text)?;
    outputs.write(&dir.join(format!("{name}.1")), &String::from_utf8_lossy(&text))?;
    for inner in command.get_subcommands() {
        pages(outputs, dir, inner, &format!("{name}-{}", inner.get_name()))?;
    }
    Ok(())
}
