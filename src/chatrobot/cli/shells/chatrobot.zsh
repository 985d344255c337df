#compdef chatrobot
# Tab completes chatrobot in zsh, after compinit:  eval "$(chatrobot completion zsh)"
_chatrobot() {
    local line word meaning
    local -a whole begun
    for line in "${(@f)$(${~words[1]} completion words -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
        word="${line%%$'\t'*}" meaning="${line#*$'\t'}"
        case $word in
            '') ;;
            :files)
                if [[ $meaning == :files ]]; then _files; else _files -g "${meaning//./*.}"; fi ;;
            :folders) _files -/ ;;
            *:) begun+=("${word//:/\\:}:$meaning") ;;
            "$line") whole+=("${word//:/\\:}") ;;
            *) whole+=("${word//:/\\:}:$meaning") ;;
        esac
    done
    (( $#whole )) && _describe chatrobot whole
    (( $#begun )) && _describe chatrobot begun -S ''
}
if [[ "${funcstack[1]}" == _chatrobot ]]; then
    _chatrobot "$@"
else
    compdef _chatrobot chatrobot
fi
