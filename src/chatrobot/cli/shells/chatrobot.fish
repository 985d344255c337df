# Tab completes chatrobot in fish:  chatrobot completion fish > ~/.config/fish/completions/chatrobot.fish
function __chatrobot_words
    set -l words (commandline -opc)
    set -l program $words[1]
    set -e words[1]
    set -l current (commandline -ct)
    for line in (command $program completion words -- $words "$current" 2>/dev/null)
        set -l ends (string split \t -- $line)
        switch $line
            case ':files'
                __fish_complete_path "$current"
            case ':files*'
                set -l pattern '(/|'(string replace -a . '\.' -- $ends[2] | string replace -a ' ' '|')')(\t|$)'
                __fish_complete_path "$current" | string match -r ".*$pattern.*" | string match -rv '^.?$'
            case ':folders'
                __fish_complete_directories "$current"
            case '*'
                printf '%s\n' $line
        end
    end
end
complete -c chatrobot -f -a '(__chatrobot_words)'
