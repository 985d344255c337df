# Tab completes chatrobot in bash:  eval "$(chatrobot completion bash)"
_chatrobot() {
    local current="${COMP_WORDS[COMP_CWORD]}" program="${COMP_WORDS[0]/#\~/$HOME}" word ends end
    local -a words=("${COMP_WORDS[@]:1:COMP_CWORD}")
    if [[ $current == '=' ]]; then
        current='' words[COMP_CWORD-1]=''
    fi
    COMPREPLY=()
    while IFS=$'\t' read -r word ends; do
        case $word in
            :files)
                compopt -o filenames
                mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(
                    [[ $ends ]] && compgen -d -- "$current"
                    for end in ${ends:-''}; do compgen -f -X "!*$end" -- "$current"; done | sort -u
                )
                ;;
            :folders) compopt -o filenames; mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$current") ;;
            *: | *=) compopt -o nospace; COMPREPLY+=("$word") ;;
            *\ *) COMPREPLY+=("$(printf %q "$word")") ;;
            *) COMPREPLY+=("$word") ;;
        esac
    done < <("$program" completion words -- "${words[@]}" 2>/dev/null)
}
complete -F _chatrobot chatrobot
