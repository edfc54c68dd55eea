r"""Grade a folder of submissions; one row each, whatever they hold.

    python -m pfkit.labs.grade lab3 submissions/ -o grades.csv --jobs 2 --cell-timeout 60 --wall 300

A submission is a notebook, or the answers that `Lab.save` and the page write (JSON). Only its
answer cells are taken and put into the lab's own notebook.

==============  ========================================================================
status          meaning
==============  ========================================================================
``ok``          every answer cell ran; the score counts
``errors``      an answer raised an exception; the score counts
``missing``     an answer cell is gone, or nothing at all is answered
``timeout``     a cell ran longer than ``--cell-timeout``, or all of them than ``--wall``
``crashed``     Python ended before the last cell
``malformed``   the file is no notebook or answers file of this lab
``review``      an answer reaches for the checker or out of its folder, or answers compete
==============  ========================================================================

The score is empty unless the status is ``ok`` or ``errors``: a zero always means "graded, and
wrong". The columns of the items show what was earned in every case.

Parts, in the order a submission meets them: `submission` (what is in the file), `suspicion` (does
it reach for the checker?), `notebook` (which cells run), `batch` (jobs and journal), `warden`
(limits from outside: time, and that nothing is left running), `runner` (executes the cells),
`seal` (limits from inside: memory, files, an unchanged checker), `outcome` (status and score),
`report` (tables and pages).

**Not a sandbox.** Answers run with your rights. Linux refuses writes outside the temporary folder
(Landlock, kernel 5.13 or newer) and limits memory and file size; macOS does only part of it,
Windows only the time limits (see `seal`). Nothing hides what you may read. For submissions of
strangers use a container; the instructor guide has the command.
"""
