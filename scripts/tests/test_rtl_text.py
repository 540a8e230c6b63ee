# SPDX-License-Identifier: Apache-2.0
"""RTL without its comments."""

import unittest

from rtl_text import without_comments


class Comments(unittest.TestCase):
    def test_blanks_stand_in_place_of_comments(self) -> None:
        for text, code in (("a; // b\nc;", "a;     \nc;"), ("a /* b */ c", "a         c"), ("/* a\n b */ c", "    \n      c"),
                           ("a // b /* c\nd", "a          \nd"), ("/* // a */ b", "           b"), ("a = b / c;", "a = b / c;")):
            self.assertEqual(without_comments(text), code)

    def test_no_comment_begins_in_a_string_and_no_string_in_a_comment(self) -> None:
        for text, code in (('s = "a // b"; // c', 's = "a // b";     '), ('s = "/* a"; b /* c */', 's = "/* a"; b        '),
                           (r's = "\" // a"; // b', r's = "\" // a";     '), ('// a "b\nc; // "d"', '       \nc;       ')):
            self.assertEqual(without_comments(text), code)

    def test_strings_become_blanks_on_request(self) -> None:
        self.assertEqual(without_comments('$display("late // %d", a); // b', strings=False), "$display(            , a);     ")


if __name__ == "__main__":
    unittest.main()
