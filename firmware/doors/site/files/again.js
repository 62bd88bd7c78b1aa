// A page of which a part did not come, such as while the network changed, would do nothing: it is loaded again.
addEventListener("error", ({ target }) => /^(script|link)$/.test(target.localName) && setTimeout(() => location.reload(), 2000), true);
