"""Text → what is to happen, by rules over data files, in English and Chinese; and codes → words.

The line through the package, from text to plan:

    text    normalise                                               lower case, one form of each character
    acts    signs (clauses and labelled words) → acts               which clauses order something; talk is left out
    text    rephrase                                                one plain form
    atoms   tokens (words from lexicon) → quantities                what each word means
    atoms   chatter, conditions, corrections, order, tidy           what was not meant left out, the rest in order
    frames  clauses, joining                                        a bag of slots for each motion
    steps   dialogue (earlier turns) or writing (this utterance)    actions: driving, turning, arcs, shapes…

`interpreter` begins it, `command` tells commands from questions and stops, `reading` holds the middle together,
`heeded` looks back over it: nothing that was said may be without effect. What is not understood is raised as
`Unclear` and asked back. `phrases` and `questions` go the other way, from codes to words.
"""
