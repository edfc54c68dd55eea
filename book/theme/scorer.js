/* How much a find is worth, for Sphinx's search. Words that a page has only in its code count a
   tenth (search_prose.py lists them). A find in the API pages, where Sphinx gives an index entry up to
   100, counts less than a word of the prose, which it gives 5. */
var Scorer = {
  score: ([page, , , , score]) => {
    const stemmer = new Stemmer();
    const words = splitQuery(new URLSearchParams(location.search).get("q") || "")
      .map((word) => stemmer.stemWord(word.toLowerCase()));
    const only = (word) => Object.hasOwn(pfCodeWords, word) && pfCodeWords[word].includes(page);
    const inCode = words.filter(only).length / Math.max(1, words.length);
    return score * (1 - 0.9 * inCode) * (/^book\/api/.test(page) ? 0.03 : 1);
  },
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
