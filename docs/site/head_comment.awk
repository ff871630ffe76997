# Doxygen's filter: the plain comment lines at a header's head as its documentation. What they indent is a
# table or code and stays as it is, unless it goes on with an item of a list.
BEGIN { head = 1 }
head && !/^\/\// {
    head = 0
    if (code) print "/// \\endcode"
}
!head { print; next }
FNR == 1 { print "/// \\file" }
{
    sub(/^\/\/ ?/, "")
    item = /^\* / || (item && /^  /)
    indented = /^  / && !item
    if (indented && !code) print "/// \\code{.unparsed}"
    if (!indented && code) print "/// \\endcode"
    code = indented
    print "/// " $0
}
