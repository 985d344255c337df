"""English words for stopping. `{a,b}` stands for either. Longest phrase first is the matcher's business."""

STOP = (
    "stop", "stpo", "sotp", "stahp", "stopp", "stop it", "stop that", "stop this", "stop there",
    "stop here", "stop moving", "stop driving", "stop turning", "stop spinning", "stop rotating",
    "stop going", "stop everything", "stop now", "stop what you're doing", "stop what you are doing",
    "stop whatever you're doing", "stop whatever it is you're doing", "stop right there",
    "stop right now", "stop all motion", "stop all movement", "stop all motors", "stop the robot",
    "stop the car", "stop the motors", "stop the wheels", "stop dead", "stop in your tracks",
    "stop motion", "stop the motion", "stop your motors", "stop your engines", "stop rolling",
    "stop running", "stop at once", "stop yourself", "stop doing that", "stop doing what you're doing",
    "stop all of that", "stop all", "stop moving around", "halt", "hlat", "halt there",
    "halt right there", "halt everything", "halt all motion", "come to a halt", "come to a stop",
    "come to a standstill", "come to a full stop", "come to a complete stop", "come to rest",
    "grind to a halt", "freeze", "freez", "freeze right there", "freeze there", "whoa", "woah", "whoah",
    "wo", "woa", "ho", "hold it", "hold it there", "hold it right there", "hold up", "hold on",
    "hold your horses", "hold still", "hold everything", "hold position", "hold your position",
    "hold right there", "stand still", "stand down", "stay put", "stay still", "stay there",
    "stay where you are", "stay right there", "stay right where you are", "keep still", "be still",
    "remain still", "remain where you are", "don't move", "dont move", "do not move",
    "don't move a muscle", "do not move a muscle", "don't move an inch", "dont move a muscle",
    "don't you move", "don't you dare move", "don't go any further", "don't go any farther",
    "go no further", "no further", "no farther", "not another inch", "not one more inch",
    "not an inch further", "not a step further", "not another step", "not one step further",
    "don't take another step", "stop cold", "do not move another inch", "don't move another inch",
    "don't move any more", "do not move any further", "don't move any further", "enough", "that's enough",
    "thats enough", "that is enough", "enough of that", "quit it", "quit", "quit that", "quit moving",
    "cease", "cease all motion", "cease moving", "cease motion", "cease all movement", "desist",
    "cease and desist", "cut it out", "cut it", "cut that out", "cut the motors", "cut the engine",
    "cut the engines", "cut power", "cut the power", "cut your motors", "cut your engines", "cut motors",
    "cut engines", "cut the throttle", "kill the motors", "kill the engine", "kill the engines",
    "kill motors", "kill power", "kill the power", "kill it", "kill switch", "kill your motors",
    "motors off", "engines off", "engine off", "motor off", "power off the motors", "turn off the motors",
    "switch off the motors", "shut off the motors", "turn the motors off", "switch the motors off",
    "shut the motors off", "shut it down", "cancel", "cancel that", "cancel it", "cancel everything",
    "cancel all", "cancel whatever it is you're doing", "cancel whatever you're doing",
    "cancel what you're doing", "cancel the command", "cancel the motion", "cancel the move",
    "cancel the order", "cancel the last command", "cancel the current command", "cancel current command",
    "cancel current motion", "cancel the mission", "cancel the task", "cancel the current motion",
    "cancel all commands", "cancel the current task", "cancel motion", "cancel movement",
    "cancel your mission", "abort", "abort that", "abort it", "abort mission", "abort the mission",
    "abort everything", "abort the motion", "abort motion", "abort the move", "abort the command",
    "abort all", "brake", "brakes", "brakes on", "brake now", "hit the brakes", "slam the brakes",
    "slam on the brakes", "apply the brakes", "apply brakes", "put the brakes on", "put on the brakes",
    "step on the brakes", "step on the brake", "full brake", "brake hard", "hit the brake", "pull over",
    "stomp on the brakes", "drop anchor", "park it", "cease fire", "knock it off", "leave it",
    "red light", "time out", "timeout", "give it a rest", "pack it in", "no more moving",
    "no more movement", "no more", "stop the show", "full stop", "all stop", "dead stop", "stop stop",
    "basta", "terminate", "terminate motion", "interrupt", "never mind stop", "nevermind stop",
    "never mind", "nevermind", "forget it", "forget that", "not another inch please", "zero velocity",
    "zero speed", "suspend", "suspend motion", "you can stop", "you can stop now", "you may stop",
    "you should stop", "you must stop", "you need to stop", "i said stop", "i told you to stop",
    "i want you to stop", "i need you to stop", "i'd like you to stop", "make it stop", "let's stop",
    "lets stop", "time to stop", "have a stop", "would you stop", "will you stop", "could you stop",
    "can you stop", "can you stop it", "will you stop it", "stay", "pause", "pause there", "pause it",
    "pause motion", "wait", "wait there", "wait right there", "stationary", "remain stationary",
    "immobilize", "immobilise", "lock the wheels", "lock your wheels", "lock wheels", "disengage",
    "disengage the motors", "disengage motors", "disable the motors", "disable motors",
    "stop your wheels", "ease off", "let go of the throttle", "that'll do stop", "that will do",
    "don't do it", "don't do that", "don't do anything", "do nothing", "stop before you hit something",
    "watch out stop", "look out stop", "halt now", "don't go", "dont go", "stop drive", "stop engine",
    "stop engines", "stop motors", "stop motor", "stop robot", "stop car", "stop move", "not move",
    "no move", "no moving", "stop you", "that's far enough", "far enough", "stand fast", "hold fast", "avast",
    "hold your fire", "nobody move", "stay exactly where you are", "stay right here", "stay here", "belay that",
    "belay that order", "shut down the motors", "motors stop", "kill the drive", "drop the throttle",
    "zero throttle", "set speed to zero", "set your speed to zero", "speed zero", "not a step more",
    "not a step farther", "don't take one more step", "whoa nelly", "whoa there", "easy there", "arrest",
    "stop whatever", "stop this nonsense", "stop that nonsense", "halt at once", "cease this",
    "stop the machine", "stop the vehicle", "stop the wheel", "stop the engine", "stop the engines",
    "stop your motion", "stop all of this", "stop dead in your tracks", "stop on the spot", "stop in place",
    "stop in the name of the law", "stop before it's too late", "discontinue", "discontinue motion",
    "quit driving", "quit rolling", "quit turning", "quit spinning", "quit doing that", "cease driving",
    "cease turning", "cease operations", "halt your motion", "halt the motors", "halt the robot",
    "halt all movement", "halt all motors", "halt operations", "freeze in place", "freeze where you are",
    "pause that", "pause the motion", "pause the robot", "suspend it", "that'll do", "thatll do", "that does it",
    "knock it off", "knock that off", "pack it in", "give it a rest", "leave it", "call a halt", "stop for now",
    "hold where you are", "hold there", "park yourself", "park right there", "do not go", "do not go further",
    "do not go any further", "do not drive", "don't drive", "don't drive any further", "do not continue",
    "don't continue", "don't keep going", "do not proceed", "don't proceed", "do not take another step",
    "drop everything", "drop it", "call it off", "scrap that", "scrub that", "scrub the mission",
    "abandon that", "abandon mission", "abandon the mission", "abort now", "abort current task",
    "stop current task", "stop the current task", "stop the task", "stop the program", "stop the mission",
    "no further movement", "no more motion", "no more driving", "all motors off", "cut all power",
    "kill all motors", "kill all power", "shut it off", "turn off your motors", "switch off your motors",
    "wheels still", "engines stop", "motors halt", "put the brake on", "pull the brake", "pull the handbrake",
    "handbrake", "hand brake", "parking brake", "anchor", "anchors", "hang on there", "hang on", "stall",
)  # fmt: skip

PAUSE = (
    "pause", "pause there", "pause it", "pause motion", "pause that", "pause the motion", "pause the robot",
    "hold on", "hold on there", "hold it", "hold it there", "hold up", "hang on", "hang on there", "wait",
    "wait there", "suspend", "suspend motion", "suspend it",
)  # fmt: skip
"""Stops that keep what was under way, for it to be gone on with."""

PAUSE_FILLER = (
    "please", "pls", "plz", "now", "right now", "ok", "okay", "hey", "robot", "and", "just", "oh", "there", "here",
    "would you", "could you", "can you", "will you", "you", "it", "thanks", "thank you", "um", "uh", "er", "so",
    "then", "yes", "sorry", "for now", "for a while", "for a moment", "for a second", "for a minute", "for a bit",
    "for a sec", "a moment", "a second", "a minute", "a sec", "a bit", "one moment", "one second", "one minute",
    "kindly", "my friend", "friend", "buddy", "mate", "hm", "hmm", "a little", "me", "quickly", "immediately",
)  # fmt: skip
"""What may stand beside a pause: nothing that might mean that it is over."""

FILLER = (
    "please", "pls", "plz", "now", "right now", "right away", "immediately", "at once", "this instant",
    "this second", "this minute", "this moment", "instantly", "straight away", "asap", "ok", "okay",
    "alright", "all right", "hey", "oi", "yo", "robot", "bot", "buddy", "mate", "dude", "man", "car",
    "machine", "and", "just", "oh", "no", "nope", "no no", "god", "oh god", "my god", "oh my god", "omg",
    "shit", "crap", "fuck", "damn", "dammit", "damn it", "there", "here", "would you", "could you",
    "can you", "will you", "you", "it", "thanks", "thank you", "ah", "argh", "aah", "aargh", "um", "uh",
    "er", "sir", "everyone", "guys", "for god's sake", "for goodness sake", "for heaven's sake",
    "for crying out loud", "i said", "i say", "i beg you", "quick", "quickly", "fast", "already", "well",
    "so", "then", "again", "yes", "right", "completely", "entirely", "altogether", "all of you", "sorry",
    "wait", "hold on", "careful", "watch out", "look out", "danger", "at this moment", "where you are",
    "right where you are", "right there", "exactly where you are", "exactly there", "dear", "little one",
    "the robot", "until i say so", "until further notice", "until i tell you", "till i say so", "for now",
    "for a while", "friend", "my friend", "rover", "you stupid thing", "you idiot", "stupid", "silly",
    "good", "good robot", "listen", "attention", "before you hit something", "before you hit the wall",
    "before you crash", "before something happens", "before something breaks", "there's a cat",
    "there is a cat", "that's a wall", "wall", "or else", "i mean it", "seriously", "really",
    "do you hear me", "did you hear me", "come on", "hurry", "the", "a", "all", "your", "me",
    "if you please", "if you would", "will ya", "lol", "kindly", "cheers", "ta", "mister", "boy",
    "at the moment", "you there", "easy", "easy now", "steady", "we are finished", "we're finished", "we are done",
    "we're done", "i'm done", "i am done", "that's it", "that's all", "in the name of the law", "this very instant",
    "this very second", "this very moment", "exactly where you are", "exactly there", "with immediate effect",
    "without delay", "before it's too late", "you hear me", "are you deaf", "wall e", "little robot", "rob",
    "for pete's sake", "for the love of god", "ffs", "for fuck's sake", "eek", "yikes", "oops", "ouch", "ow",
    "help", "eh", "hm", "hmm", "hello", "hi", "thank goodness", "i repeat", "repeat", "any more", "anymore",
    "any further", "any farther", "as you are", "dead", "cold", "too far", "that's too far", "not good",
    "bad robot", "bad", "naughty robot", "there's a child", "there's a dog", "there is a child", "a wall",
)  # fmt: skip

EMERGENCY = (
    "emergency stop", "emergency", "e stop", "estop", "emergency halt", "emergency brake",
    "emergency shutdown", "emergency off", "hit the emergency stop", "press the emergency stop",
    "trigger the emergency stop", "e-stop", "panic stop", "activate the emergency stop",
    "engage the emergency stop", "emergency stop now", "hit the e stop", "hit the estop",
    "push the emergency stop", "push the emergency button", "press the e stop", "mayday",
    "do an emergency stop", "make an emergency stop",
)  # fmt: skip

RELEASE = (
    "release", "release the emergency stop", "release emergency stop", "release the e stop",
    "release e stop", "release estop", "release the estop", "clear the emergency stop",
    "clear emergency stop", "clear the e stop", "clear estop", "clear e stop", "reset the emergency stop",
    "reset emergency stop", "reset the e stop", "reset estop", "unlock", "unlock the robot",
    "lift the emergency stop", "undo the emergency stop",
)  # fmt: skip

RELEASE_FILLER = (
    "please", "pls", "plz", "now", "right now", "kindly", "thanks", "thank you", "ok", "okay", "just", "then",
    "can you", "could you", "would you", "will you", "you", "hey", "hi", "hello", "robot", "the robot",
)  # fmt: skip
"""What may stand beside a release: nothing that might mean the opposite, or that something is wrong."""

DOUBLED = (
    "stop", "halt", "freeze", "whoa", "no",
)  # fmt: skip
"""Words people stretch: `stoooop`, `haaalt`."""

NOT_DOUBLED = ("stoop",)

CANCELLED = (
    "never mind", "nevermind", "forget it", "forget that", "forget about it", "scratch that",
    "cancel that", "on second thought don't", "actually don't", "actually stop", "actually no stop",
    "no don't", "no stop", "don't move", "don't go", "stop", "wait stop", "don't", "no wait stop",
    "actually no", "actually never mind", "stay there", "stay put", "hold it", "halt", "freeze",
)  # fmt: skip
"""What takes a sentence back when it stands at its end after a break."""

TAKEN_BACK = (
    "never mind", "nevermind", "forget it", "forget that", "forget about it", "scratch that",
    "cancel that", "actually don't", "no don't", "actually never mind", "on second thought don't",
    "actually no stop", "no stop", "no wait stop",
)  # fmt: skip
"""Of these, what takes a whole command back even where the sentence did not break off."""
