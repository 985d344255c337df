"""English words one edit from a word of a stop phrase, or of what stands beside one: they are meant as they stand."""

WORDS = """
abandons aborts abound abut act activated activates add aero affect afire age ago aground aid airest alight alike
aloud alt am amply amway anger ant anther anythings apple aptly arch area argo argy aright ark arm armrest arrests art
as asaph ask asp ate atop attentions avant ave aver avery awa await awhile awry back baddy bait bake bakes ball ban
band bang banger bar bard bare bark barking base bask basra bast baste batch bate bay bead beaks bean bear bed bee
beep bela belau belays bell belly bely best bet bets biddy bight bike bikes bill billy bind bit blake blast blat
bleaks blight block bock boing bold bonce bone book bops border bore bout bower brace braces braked brash brave braves
braze brazes breads break breams breeze brest bright broke buck budd buick bull bundy burn burning burton bush bust
but buttons buxton buys by bye cake cal calc calf cali calk calla calls calm came can't cancels cancer cant cap card
care cark carking carl carp cars cartful case cash cask cast cat catch cause cave ceased ceases cell cello chancel
chang chap chard chase chat chats cheeks cheeps cheer cheery chen chewers chile chili chill ching chis chit chow cinch
clam clap clash clast cleave clock clod cloud clove cock cod code coe coed coke col cola colds cole coll colo cols
colt com coma comae comb comer comes comet comm commando commandos commend commends como comp compand compands compete
completed completer completes comte cone cont continua continued continuer continues cook coops cope cops cord corder
core cote couch couldn't cove cover coving cow cower coying crab cracks crag cram cramp crape craps crass craw cray
creaks crease cress crest crop crush cryings cull cunning cup currant currents curry cute dace dad dade dagger dale
dam dame dammits damns damon damp dams dan dancer dander dane dang danged dangers dangler danker dar dara dared daren
darer dares darger dark darking darn dart date dave dawn day daze dding dea deal dean dears deary debar decaf decay
deed deep deer def deist delays dell demist dent derive deriving desists detr dewar dhow didn't dike dikes dill dilly
dime dine ding dint dione dire disabled disabler disables discontinued discontinues disengaged disengages dive diving
dock doe doesn't dog doge doings dole doling dolling dolt dome doming don don's dona dong donn donne dons dope doping
dose dosing dost dot dote doting dour dove dover dow dower downs downy doze dozing drake drakes dread drear dress drip
drivel driven driver drives drivings drone droop drops drove drover droving drown drying duck dud duded dudes duds due
duke dull dune dunning dupe duse dust dwell dyad dying dyne ear eas eased easel easer eases east eat eave effects
eight eire elam elate elbe elise ell elle elsa elsey elsie emergence emission emotion encage end engaged engages
engined enrage entirety erase ere erse erst ese est ets ever every fact factually fair faire fake fall fame fan fang
fare farm fart fas faso fass fasts fat fate father fats faust fave fear feast feed fell fest fever fibre fie fiend
fife fight file fill filly finch find fine finisher finishes fir fired firer fires firm firs fission fist five flat
flight flock fold foll foment font food fops for fore forge forged forger forges forgets forgot four fracks frap
freaks free freed freer frees freezer freezes fried friends frieze fright frying fucks fuel fulls fully funk furl furn
furry furthers gain gait gall game gang ganger gate gave gay gays gear geed gere germinate get gets ghat ghats gibe
gide gill gite given giver gives glace glam glisten glove goad god gods goings gold gone gong goo goods goody goof
gook goon goop gore goring gorses got gould gove gower gown grand grid grin grinds grins ground grover guis gull gums
gunning guns gus gush gust guts guvs guy gyve haag hack had hadn't hae hag hake half hall hallo halts halve han
handbrakes hands handy hanger hangi hangs hank hanks hans happen hara hards hardy hare hared hark harking harm harp
harry hart hasn't hat hatch hate hats haughty havel haven haver haves haze he he's head heal heap heard hears heart
heat heave heavens hebe heed heel heels heep heir held hell hellos hells helm helps heme hemp hen hep her hera herb
herd here's herne hero herr hers hi hight hike hikes hill hilly hilt him hind hing hire his hits hive hoar hoard hock
hod hoed holds hole holed holm hols holt holy home hone hong hood hook hoops hope hops hordes horse horsed horsey
hoses hot hour houses hove hover how huang huck hull hullo hung hurly hurray hush hut hutton i'd i'll idiom idiots if
ike ilam ill illy immobilis immobilised immobiliser immobilises immobilized immobilizer immobilizes inc inca incl incs
ind instants interrupts iops ire islam isn't it's itch its jack jake jame jean jeep jell jello jelly jest jets jill
jive jock joust jove jude justs jut juts kant kate kay keel keen keeps kelly kelp kemp kiel kike kikes kills kiln kilo
kilt kind kindle kingly kit kith knack kneed knick knocks know kook krill kwell lace lack lade laid lake lam lame land
lane lang langer lard lark larking las lase lash lass lasts lat latch later latex lath lathe lats latte laud laue lave
lawn lay laze lead leaf lean lear leas lease least leaved leaven leaver leaves led leds lees left lefts leg legs leis
lens lents leos les less lest let's leta lever lice lick lie life lights liked liken liker likes lilly lime lind line
lire list listed listens lister liston lite littler littles live load lobe loch loci locke locks loco lode loge
lolling lome lone loo looks loom loon loop loops loos loot lope lops lord lore lorry lose lost lot lotion lots lou
lour lout loved lover loves lovey loving low lowe lower loyd lsat luck luke lull lush lust lute mace machined machines
mack mad made mae mage maid maker makes male mall malt man mane manger manic many map mare mark marking mask mast
master mat match mated mateo mater mates matey math mats matt matte maydays maze me mead meal means meant meany meas
meat medan meed megan meister men mend mere mery met mete mid might mike mikes mild mill milter mimd mime min mina
minds mindy mine mined ming mini mink minn mins minster mint minter minuet minuted minuter minutes minx mire miser
missions mist misted misters mistier mite miter moan mock mode moe moire moister mold mole momenta moments mont mood
mooing moor moore moors mope moping mops mora moree morel mores morn moro morse mort most mote motions moue mouing
mould mov moved movements mover moves movie movings mower mowing mown mst much muck muddy mull murry mus musa muscled
muscles muscly muse mush musk muss muster musts musty mute mutt mutton my myst nae nam named namer names nand nape
nark natch nate naught naughts nave near ned nee needs needy neely neep nell nerd nero nest net nets new newer newly
night nike nilly noah nock node noe nome nonce none nonsenses nook nor northing nose noshing notating notching note
nothings noticed notices noting notion notting novice nude null och odder oder ogive oh ohing ok okays old older
omission oncer oner ont oohs ope operation ops or orders ore ounce our ourself oust oven overs overt owe own pac pace
packing packs pact pacy paid palace pall pan pang panics panis pant par para parc pare paring parka parks parky parr
parring pars parse parsing part parting passe past pasta patch pate paused pauses pave pay payday peace pear peck peed
peep pell perk perking pest peters pets phat phis pick pike pikes pill pin pinch pinning pirk pith placed placer
places plage plaice plane plate pleased pleaser pleases plight plush pock poker poler poll polling ponce pone poops
pope pops pore pork poser posh positions positron pot potion pouch pour powder powers prems preps pres preys proceeds
programs prop prying puck pugh pule pulls pulp punic punning purl pus pushy puss quack quicks quid quiet quilt quirk
quite quits quiz rack racks raid rake rakes rally ran rand rang ranger rant rap rare rarest rash rasta rate rave raver
raw read realty rear reed regain regally reheat reilly reit relay remains rent repeal repeats repent res resat reseat
reset resist resit resp rests retain rid rigger righto rights rill rime rind rive river riving robots robt rock roger
roiling rollin rollings rollins rome rood rook root rope roper rorer rotor rotors rotting round rove roved rovers
roves roving row rower rowling ruck ruddy rude ruining rush rust sack sad sade sae safe sage sail saker sakes saki
saks sale sally salt sam same sand sane sang sanger sap sase sask sat sate save saw say scam scarp scilly scold scot
scow scrag scram scrape scraps scratchy scrip scrubs scrum sea seam sean sear seat seconds see seed seep sell sent sep
sere sets sever sex shake shall shalt sham shank shanks shard shat shave shaw shay she she's shear sheers shew shift
shill shim shin shinning ship shirt shits shiv shod shoe shoo shop shot shouldn't shout shown shows showy shpt shrub
shun shunt shutdowns shute shuts siam sid sight silky sill sills silty sinning sire sister sit sith sive skid skill
skinning skit slab slag slake slams slap slate slav slaw slay slid slight slim slit slop slot slow slum slut small
smut snake sneed snit snitch snot snow so soap sock sold some somethings son sook soot sops sore sot soup sour sow
sower sown spake spam spanning spark sparking spat spay sped speedo speeds speedy speer spend spewed spied spill spit
sport spots spout spreed sta stab stag staid stake stale stalk stalls stamp stan stands standstills stank star stat
stationery stays ste stead steads steamy steed steep stem steps stet stew stile stills stilt stitch stol stoma stomps
stompy stoop stops stoup stow straights strand strap stray strep strop stump stupids sty such suck suit sully sunning
suspends sutton swam swatch sway swell swill swot tack tacks tactually tait taken taker takes tale talk tall tame tang
tank tanks tape tare tarn tasks tass tat tate tats tay teal tear tease teat teats teed teen tefl tel tells telly ten
terminated terminates tern tesl test thad thai thais than thane thanes thanh thant thar that's thaw thaws thea thee
them theme theo there's therm these thew they they'd thin thine things thingy think thinks thins thong though thoughts
three throttled throttler throttles thunk thunks thus tide tie tight til tile tills tilt tim timed timeouts timer
times timex tims tine ting tire tittle toad tock tod todd toe toed tokay toke tole toll tolling tome tone took tool
top topp tops tore torn touch tour tower town toy traces track tracts trap trash tress tricks trigged triggers trill
trolling trucks trying tuck tull tun tuning turd turf turfing turin turing turk turnings turns tush tusk twat twats
twill twitch two tying tyke untie urn urogram us vang vary vase vast veep vehicles vera verb vern vert vesicle vest
vets vouch wack waft wail waist waits wake wald wale walk walls wally walt wan wand wane wang wank wants war ward ware
wart wasn't watt wave way we we'd we'll we've weal wean wear weave weed weep weill weld wella wells welly welt went
were west wet wets whale wham whare what's whats wheal wheals wheat whee whelp when where's wheres whet whiled whiles
whine whit white who who's whole whom whoo whop whore width wight wild wile willa wills willy wilt wily win winch wind
wire wish wit witch withe wits wive woad wold won won't wont wood wops wore world worry wouldn't woulds wound wove
wracks wrap wreaks wrest wright writ yack yang yard year yell yelp yest yet yokes yore you'd you've yours yous yuck
zack zeno zeros zest zone
"""
